//! Finding the probe that is meant; which there are, the chips behind them, and what runs in those.

use host_sim::Error;
use probe_rs::probe::Probe;
use probe_rs::probe::list::{Accessibility, Lister, ProbeListItem};

use super::SeenProbe;
use super::behind::Behind;
use super::memory::MemoryPort;
use crate::configuration::RunsBy;
use crate::conversation::Conversation;
use crate::source::{BoardName, Laying};

fn seen_as(item: &ProbeListItem) -> SeenProbe {
    SeenProbe {
        name: item.info.identifier.clone(),
        serial: item.info.serial_number.clone().unwrap_or_default(),
        may_open: item.accessibility == Accessibility::Accessible,
        chip: Err("not looked at".to_owned()),
        module: None,
    }
}

/// Fails as [`open`] does, as far as is known without opening.
pub(crate) fn is_there(selector: &str) -> Result<(), Error> {
    let items = Lister::new().list_all_with_access();
    let seen: Vec<_> = items.iter().map(seen_as).collect();
    chosen(&seen, selector).map(drop).map_err(Error::Work)
}

/// Opens the probe whose serial number begins with `selector`; the only one, if that is empty.
pub(super) fn open(selector: &str) -> Result<Probe, Error> {
    let items = Lister::new().list_all_with_access();
    let seen: Vec<_> = items.iter().map(seen_as).collect();
    let found = chosen(&seen, selector).map_err(Error::Work)?;
    items[found].info.open().map_err(|error| {
        Error::Work(format!(
            "{} {}: {error}; does another program hold it?",
            seen[found].name, seen[found].serial
        ))
    })
}

fn chosen(seen: &[SeenProbe], selector: &str) -> Result<usize, String> {
    let name = |probe: &SeenProbe| format!("{} ({})", probe.serial, probe.name);
    let all = seen.iter().map(name).collect::<Vec<_>>().join(", ");
    let mut fit = (0..seen.len()).filter(|n| seen[*n].serial.starts_with(selector));
    match (fit.next(), fit.next()) {
        (None, _) if seen.is_empty() => Err(
            "no probe found: is the board on USB by its ST-LINK socket, by a cable that carries \
             data? whisker doctor says what is missing"
                .to_owned(),
        ),
        (None, _) => Err(format!(
            "--probe: found no serial number that begins with {selector:?}; allowed: {all}"
        )),
        (Some(_), Some(_)) => Err(format!(
            "which probe? allowed: --probe SERIAL, the beginning of one of: {all}"
        )),
        (Some(n), None) if !seen[n].may_open => Err(format!(
            "{}: this user may not open it; whisker doctor says what mends that",
            name(&seen[n])
        )),
        (Some(n), None) => Ok(n),
    }
}

/// All probes on USB, and the chips behind those that may be opened.
#[allow(
    clippy::unnecessary_wraps,
    reason = "without probe-rs nothing can be seen"
)]
pub(crate) fn seen(board: BoardName) -> Result<Vec<SeenProbe>, String> {
    let mut all = Vec::new();
    for item in Lister::new().list_all_with_access() {
        let mut probe = seen_as(&item);
        if probe.may_open {
            let chip = item.info.open().map_err(|error| error.to_string());
            let chip = chip.and_then(|open| {
                let mut memory = MemoryPort::of(open).map_err(|error| error.to_string())?;
                memory.chip_id(board).map_err(|error| error.to_string())
            });
            if chip == Ok(board.board().chip_id) {
                probe.module = runs(&item, board).ok();
            }
            probe.chip = chip;
        }
        all.push(probe);
    }
    Ok(all)
}

fn runs(item: &ProbeListItem, board: BoardName) -> Result<String, Error> {
    let probe = item.info.open();
    let probe = probe.map_err(|error| Error::Work(error.to_string()))?;
    let module = Behind::new(probe, board, None, Laying::by(None))?;
    let runs_by = RunsBy::ask(&mut Conversation::new(Box::new(module)))?;
    Ok(runs_by.to_string())
}

#[cfg(test)]
mod tests {
    use super::{SeenProbe, chosen};

    fn probe(serial: &str, may_open: bool) -> SeenProbe {
        SeenProbe {
            name: "STLink V2-1".to_owned(),
            serial: serial.to_owned(),
            may_open,
            chip: Err(String::new()),
            module: None,
        }
    }

    #[test]
    fn one_probe_must_be_meant() {
        let two = [probe("0661FF", true), probe("0670AA", true)];
        assert_eq!(chosen(&two[..1], ""), Ok(0));
        assert_eq!(chosen(&two, "067"), Ok(1));
        for (seen, selector, says) in [
            (&two[..0], "", "no probe found"),
            (&two[..0], "06", "no probe found"),
            (&two[..], "", "which probe?"),
            (&two[..], "06", "0661FF (STLink V2-1), 0670AA"),
            (&two[..], "1", "begins with \"1\""),
            (&[probe("0661FF", false)], "", "may not open it"),
        ] {
            let refusal = chosen(seen, selector).unwrap_err();
            assert!(refusal.contains(says), "{selector:?}: {refusal}");
        }
    }
}
