//! Which probes and chips there are, and what runs in them.

use host_sim::Error;
use probe_rs::probe::list::{Lister, ProbeListItem};

use super::SeenProbe;
use super::behind::Behind;
use super::find::seen_as;
use super::memory::MemoryPort;
use crate::configuration::RunsBy;
use crate::conversation::Conversation;
use crate::source::{BoardName, Laying};

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
