//! What is missing, by what was found, and the command that mends it.

use std::fmt::{self, Display};

use clap::ValueEnum;

use super::Facts;
use crate::probe::SeenProbe;
use crate::source::BoardName;

/// What somebody wants to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Purpose {
    /// Simulate, also a board's program on an emulated chip
    Sim,
    /// Flash a board and talk with it through its debug probe
    Probe,
    /// Talk with a board through its serial port
    Port,
}

impl Purpose {
    const ALL: [Self; 3] = [Self::Sim, Self::Probe, Self::Port];
}

/// Something that was looked for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Check {
    what: String,
    /// What mends it, where it is missing.
    mend: Option<String>,
    is_needed: bool,
}

impl Display for Check {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, mend, .. } = self;
        match mend {
            None => write!(f, "ok       {what}"),
            Some(mend) if self.is_needed => write!(f, "missing  {what}: {mend}"),
            Some(mend) => write!(f, "absent   {what} (not needed here): {mend}"),
        }
    }
}

/// Whether nothing that is needed is missing.
pub(crate) fn is_well(checks: &[Check]) -> bool {
    checks
        .iter()
        .all(|check| check.mend.is_none() || !check.is_needed)
}

/// Free room for a first build of a board's program and of this one, MiB: an estimate.
const ROOM_MIB: u64 = 2048;

/// Lets whoever sits at the PC, or is of the group plugdev, open an ST-LINK.
const RULES: &str = "echo 'SUBSYSTEM==\"usb\", ATTR{idVendor}==\"0483\", MODE=\"660\", \
                     GROUP=\"plugdev\", TAG+=\"uaccess\"' | sudo tee \
                     /etc/udev/rules.d/69-whisker.rules && sudo udevadm control --reload && \
                     sudo udevadm trigger";

/// All checks for these purposes; without any, for all of them.
pub(crate) fn checks(facts: &Facts, board: BoardName, purposes: &[Purpose]) -> Vec<Check> {
    let purposes = match purposes {
        [] => &Purpose::ALL,
        some => some,
    };
    let of = |purposes_of: &'static [Purpose]| {
        let is_needed = purposes.iter().any(|purpose| purposes_of.contains(purpose));
        move |what: String, mend: Option<String>| Check {
            what,
            mend,
            is_needed,
        }
    };
    let (all, probe, port) = (
        of(&Purpose::ALL),
        of(&[Purpose::Probe]),
        of(&[Purpose::Port]),
    );
    let mut checks: Vec<Check> = Vec::new();
    checks.extend(toolchain(facts).map(|(what, mend)| all(what, mend)));
    checks.push({
        let (what, mend) = room(facts);
        all(what, mend)
    });
    checks.extend(probes(facts, board).map(|(what, mend)| probe(what, mend)));
    checks.extend(ports(facts).map(|(what, mend)| port(what, mend)));
    checks
}

/// What was looked for, and what mends it.
type Finding = (String, Option<String>);

fn finding(what: impl Into<String>, is_there: bool, mend: impl Into<String>) -> Finding {
    (what.into(), (!is_there).then(|| mend.into()))
}

fn toolchain(facts: &Facts) -> impl Iterator<Item = Finding> {
    let Facts {
        toolchain, rustup, ..
    } = facts;
    let version = rustup.as_deref();
    let first = match version {
        Some(version) => finding(format!("rustup {version}"), true, ""),
        None => finding(
            "rustup",
            false,
            "curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs | sh",
        ),
    };
    let begins = format!("{toolchain}-");
    let has_toolchain = facts
        .toolchains
        .iter()
        .any(|name| name == toolchain || name.starts_with(&begins));
    let second = finding(
        format!("toolchain {toolchain}"),
        has_toolchain,
        format!("rustup toolchain install {toolchain}"),
    );
    let targets = facts.targets.iter().map(move |target| {
        finding(
            format!("target {target}"),
            has_toolchain && facts.fetched.contains(target),
            format!("rustup target add --toolchain {toolchain} {target}"),
        )
    });
    [first, second].into_iter().chain(targets)
}

fn room(facts: &Facts) -> Finding {
    match facts.free_mib {
        Some(free) => finding(
            format!("free disk, {:.1} GiB", free as f64 / 1024.0),
            free >= ROOM_MIB,
            format!(
                "{} GiB are needed; cargo clean removes what was built",
                ROOM_MIB / 1024
            ),
        ),
        None => finding("free disk, which is unknown here", true, ""),
    }
}

fn probes(facts: &Facts, board: BoardName) -> impl Iterator<Item = Finding> {
    let seen = match &facts.probes {
        Ok(probes) => probes.as_slice(),
        Err(why) => return vec![finding("debug probe", false, why.as_str())].into_iter(),
    };
    let mut found = Vec::new();
    if facts.is_linux {
        let may = if seen.is_empty() {
            facts.is_root || facts.has_rules
        } else {
            seen.iter().all(|probe| probe.may_open)
        };
        let mend = if facts.has_rules {
            "sudo usermod -aG plugdev $USER, then log in again, and plug the board in again"
        } else {
            RULES
        };
        found.push(finding("permission for debug probes", may, mend));
    }
    if seen.is_empty() {
        found.push(finding(
            "debug probe",
            false,
            "plug the board in by its ST-LINK socket, with a cable that carries data",
        ));
    }
    for probe in seen {
        let SeenProbe { name, serial, .. } = probe;
        found.push(finding(format!("debug probe {name} {serial}"), true, ""));
        if probe.may_open {
            found.push(chip(probe, board));
            let module = probe.module.as_ref();
            found.extend(module.map(|runs| finding(format!("module {runs}"), true, "")));
        }
    }
    found.into_iter()
}

fn chip(probe: &SeenProbe, board: BoardName) -> Finding {
    let wanted = board.chip();
    match &probe.chip {
        Ok(found) if *found == board.chip_id() => finding(format!("chip {wanted}"), true, ""),
        Ok(found) => finding(
            format!("chip {wanted} (found identity {found:#05x})"),
            false,
            "--board says which board it is",
        ),
        Err(why) => finding(format!("chip {wanted}"), false, why.as_str()),
    }
}

fn ports(facts: &Facts) -> impl Iterator<Item = Finding> {
    let mut found = Vec::new();
    if !facts.is_linux {
        let what = "serial port, which is looked for on Linux alone";
        found.push(finding(what, true, ""));
    } else if facts.ports.is_empty() {
        found.push(finding(
            "serial port of an ST-LINK",
            false,
            "plug the board in by its ST-LINK socket, with a cable that carries data",
        ));
    }
    for port in &facts.ports {
        found.push(finding(
            format!("serial port {}", port.path.display()),
            port.may_open,
            "sudo usermod -aG dialout $USER, then log in again",
        ));
    }
    found.into_iter()
}

#[cfg(test)]
mod tests;
