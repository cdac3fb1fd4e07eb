//! What is missing, by what was found, and the command that mends it.

use std::fmt::Display;

use clap::ValueEnum;

use super::Facts;
use crate::probe::SeenProbe;
use crate::source::{Board, BoardName, workspace};

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

/// Free room for a first build of host-sim and of this program, which took 1.3 GiB (`du -sm target`
/// after `cargo build -p host-sim` and `-p whisker`), and of a board's program, some hundred MiB;
/// and for what speaks to probes besides, an estimate. GiB.
const ROOM_GIB: u64 = 2;
const PROBE_ROOM_GIB: u64 = 1;

/// Lets whoever sits at the PC, or is of the group plugdev, open an ST-LINK.
const RULES: &str = "echo 'SUBSYSTEM==\"usb\", ATTR{idVendor}==\"0483\", MODE=\"660\", \
                     GROUP=\"plugdev\", TAG+=\"uaccess\"' | sudo tee \
                     /etc/udev/rules.d/69-whisker.rules && sudo udevadm control --reload && \
                     sudo udevadm trigger";

/// A line for each check, and whether all is there that is needed.
pub(crate) struct Checks {
    pub(crate) lines: Vec<String>,
    pub(crate) is_well: bool,
    is_needed: bool,
}

impl Checks {
    fn put(&mut self, what: impl Display, is_there: bool, mend: impl Display) {
        self.lines.push(match (is_there, self.is_needed) {
            (true, _) => format!("ok       {what}"),
            (false, true) => format!("missing  {what}: {mend}"),
            (false, false) => format!("absent   {what} (not needed here): {mend}"),
        });
        self.is_well &= is_there || !self.is_needed;
    }

    fn found(&mut self, what: impl Display) {
        self.put(what, true, "");
    }
}

/// All checks for these purposes; without any, for all of them.
pub(crate) fn checks(facts: &Facts, board: BoardName, purposes: &[Purpose]) -> Checks {
    let is_for = |purpose| purposes.is_empty() || purposes.contains(&purpose);
    let mut list = Checks {
        lines: Vec::new(),
        is_well: true,
        // A release builds nothing.
        is_needed: workspace().is_some(),
    };
    toolchain(facts, &mut list);
    let more_gib = u64::from(is_for(Purpose::Probe)) * PROBE_ROOM_GIB;
    room(facts, ROOM_GIB + more_gib, &mut list);
    list.is_needed = is_for(Purpose::Probe);
    probes(facts, board, &mut list);
    list.is_needed = is_for(Purpose::Port);
    ports(facts, &mut list);
    list
}

fn toolchain(facts: &Facts, list: &mut Checks) {
    let install = "curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs | sh";
    match &facts.rustup {
        Some(version) => list.found(format!("rustup {version}")),
        None => list.put("rustup", false, install),
    }
    let toolchain = &facts.toolchain;
    let begins = format!("{toolchain}-");
    let mut names = facts.toolchains.iter();
    let is_there = names.any(|name| name == toolchain || name.starts_with(&begins));
    list.put(
        format!("toolchain {toolchain}"),
        is_there,
        format!("rustup toolchain install {toolchain}"),
    );
    for target in &facts.targets {
        list.put(
            format!("target {target}"),
            is_there && facts.fetched.contains(target),
            format!("rustup target add --toolchain {toolchain} {target}"),
        );
    }
}

fn room(facts: &Facts, needed_gib: u64, list: &mut Checks) {
    let Some(free) = facts.free_mib else {
        return list.found(format!(
            "free disk, which is unknown here (needed: {needed_gib} GiB)"
        ));
    };
    let free_gib = free as f64 / 1024.0;
    list.put(
        format!("free disk, {free_gib:.1} GiB (needed: {needed_gib} GiB)"),
        free >= needed_gib * 1024,
        "cargo clean removes what was built",
    );
}

const PLUG_IN: &str = "plug the board in by its ST-LINK socket, with a cable that carries data";

fn probes(facts: &Facts, board: BoardName, list: &mut Checks) {
    let seen = match &facts.probes {
        Ok(probes) => probes,
        Err(why) => return list.put("debug probe", false, why),
    };
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
        list.put("permission for debug probes", may, mend);
    }
    if seen.is_empty() {
        list.put("debug probe", false, PLUG_IN);
    }
    for probe in seen {
        list.found(format!("debug probe {} {}", probe.name, probe.serial));
        if probe.may_open {
            chip(probe, board, list);
            if let Some(runs) = &probe.module {
                list.found(format!("module {runs}"));
            }
        }
    }
}

fn chip(probe: &SeenProbe, board: BoardName, list: &mut Checks) {
    let Board { chip, chip_id, .. } = board.board();
    match &probe.chip {
        Ok(found) if *found == chip_id => list.found(format!("chip {chip}")),
        Ok(found) => {
            let found = format!("chip {chip} (found identity {found:#05x})");
            list.put(found, false, "--board says which board it is");
        }
        Err(why) => list.put(format!("chip {chip}"), false, why),
    }
}

fn ports(facts: &Facts, list: &mut Checks) {
    if !facts.is_linux {
        list.found("serial port, which is looked for on Linux alone");
    } else if facts.ports.is_empty() {
        list.put("serial port of an ST-LINK", false, PLUG_IN);
    }
    for port in &facts.ports {
        list.put(
            format!("serial port {}", port.path.display()),
            port.may_open,
            "sudo usermod -aG dialout $USER, then log in again",
        );
    }
}

#[cfg(test)]
mod tests;
