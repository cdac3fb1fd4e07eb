//! The table of sizes: as it is committed, for a person to read, and compared.

use std::fmt::Write as _;

use crate::figures::{Figure, Table};
use crate::firmware::Size;
use crate::run::Fault;

/// The committed table.
pub(crate) const TABLE: Table = Table {
    file: "docs/measured/sizes.csv",
    header: "scene,board,flash_bytes,ram_bytes,stack_bytes",
    decimals: &[0; 3],
    slack: 0.02,
    command: "cargo xtask size",
};

/// Goals, bytes: flash without the model for a passive and an active scene,
/// logging included; static RAM; stack.
///
/// 1536 of stack were met before whiskers decided together and motors were guarded. Now scene
/// `full` takes most, on the G071: what is perceived with is built on the stack at the start and
/// moved to its place once. 25 KiB of flash were met before drivers were shared by two sides;
/// that and what else a motor near fingers needs may take 48. A passive scene took less than 8
/// until readings were held for plausible, starts were recorded and counted, settings were
/// summed in idle, and every fault, of the program too, had its line; less than 12 until it told a
/// PC of every tick and carried out what that asked for; less than 14 until its constants could be
/// read and set while it runs, which also took the stack of the start from 2 KiB to 3.5: the sums
/// of what may change are made there.
const PASSIVE_FLASH: u64 = 17 * 1024;
const ACTIVE_FLASH: u64 = 48 * 1024;
/// Flash more of a scene with a serial port: its lines, what it understands, and the text of
/// every fault, which a log has on the PC.
const SERIAL_FLASH: u64 = 20 * 1024;
/// Flash more of a scene whose model is deployed: the loader that writes it.
const LOADER_FLASH: u64 = 4 * 1024;
const RAM: u64 = 10 * 1024;
const STACK: u64 = 3584;
/// Of each whisker but the first whose samples are classified: a classifier more on its way to
/// its place.
const STACK_MORE: u64 = 2048;

/// The goals in words.
pub(crate) fn goals() -> String {
    format!(
        "The goals are {ACTIVE_FLASH} of flash without the model ({PASSIVE_FLASH} for a passive\n\
         scene, {SERIAL_FLASH} more with a serial port, {LOADER_FLASH} more with a loader), {RAM} of\n\
         static RAM, and {STACK} of stack, {STACK_MORE} more for each whisker but the first that is\n\
         listened to."
    )
}

/// What the firmware of a scene takes on a board.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Row {
    pub(super) scene: String,
    pub(super) board: String,
    pub(super) size: Size,
    /// Worst stack.
    pub(super) stack: u64,
    // Not in the committed table:
    /// Bytes of flash that are the model.
    pub(super) model: u64,
    /// Whether it whisks.
    pub(super) is_active: bool,
    /// Whether it has a serial port.
    pub(super) has_serial: bool,
    /// Whether it writes a model into its flash.
    pub(super) has_loader: bool,
    /// How many whiskers it classifies the samples of.
    pub(super) heard: u64,
    /// What host-sim takes a tick, where that was timed.
    pub(super) host_ns: Option<u64>,
}

impl Row {
    /// Its line in the committed table.
    pub(super) fn figure(&self) -> Figure {
        let numbers = [self.size.flash, self.size.ram, self.stack];
        Figure {
            key: vec![self.scene.clone(), self.board.clone()],
            numbers: numbers.map(|bytes| bytes as f64).to_vec(),
        }
    }

    fn missed_goals(&self) -> impl Iterator<Item = String> {
        let flash = [PASSIVE_FLASH, ACTIVE_FLASH][usize::from(self.is_active)]
            + SERIAL_FLASH * u64::from(self.has_serial)
            + LOADER_FLASH * u64::from(self.has_loader);
        let program = self.size.flash - self.model;
        let stack = STACK + STACK_MORE * self.heard.saturating_sub(1);
        let goals = [
            ("flash without the model", program, flash),
            ("static RAM", self.size.ram, RAM),
            ("stack", self.stack, stack),
        ];
        let place = format!("{} on {}", self.scene, self.board);
        goals
            .into_iter()
            .filter(|(_, found, goal)| found > goal)
            .map(move |(what, found, goal)| format!("{place}: {what} {found}, goal {goal}"))
    }
}

/// The table for a person to read, with what host-sim takes and what flash
/// would be without the model.
pub(super) fn columns(rows: &[Row]) -> String {
    let mut lines = format!(
        "{:<12} {:<14} {:>7} {:>14} {:>6} {:>6} {:>12}\n",
        "scene", "board", "flash", "without model", "RAM", "stack", "host ns/tick"
    );
    for row in rows {
        let Size { flash, ram } = row.size;
        let program = flash - row.model;
        let host_ns = row
            .host_ns
            .map_or_else(|| "-".to_owned(), |ns| ns.to_string());
        let _ = writeln!(
            lines,
            "{:<12} {:<14} {flash:>7} {program:>14} {ram:>6} {:>6} {host_ns:>12}",
            row.scene, row.board, row.stack
        );
    }
    lines
}

/// Names every program in `found` that has grown, is new or misses a goal; where
/// `found` `is_all`, also what is gone.
///
/// # Errors
/// If there is one.
pub(super) fn compare(known: &[Figure], found: &[Row], is_all: bool) -> Result<(), Fault> {
    let mut faults: Vec<String> = found.iter().flat_map(Row::missed_goals).collect();
    let figures: Vec<Figure> = found.iter().map(Row::figure).collect();
    faults.extend(TABLE.compare(known, &figures, is_all).err());
    if faults.is_empty() {
        Ok(())
    } else {
        Err(faults.join("\n"))
    }
}

#[cfg(test)]
mod tests {
    use super::{
        ACTIVE_FLASH, PASSIVE_FLASH, RAM, Row, SERIAL_FLASH, STACK, STACK_MORE, Size, TABLE,
        compare,
    };

    fn row(scene: &str, flash: u64, ram: u64, stack: u64) -> Row {
        Row {
            scene: scene.to_owned(),
            board: "b".to_owned(),
            size: Size { flash, ram },
            stack,
            model: 0,
            is_active: true,
            has_serial: false,
            has_loader: false,
            heard: 1,
            host_ns: None,
        }
    }

    #[test]
    fn a_table_is_read_back_as_it_was_written() {
        let rows = [row("a", 10_000, 1_000, 500), row("b", 1, 2, 3)];
        let text = TABLE.text(&rows.each_ref().map(Row::figure));
        assert_eq!(
            TABLE.parse(&text),
            Ok(rows.each_ref().map(Row::figure).to_vec())
        );
        assert!(TABLE.parse("scene,board\n").is_err());
        assert!(TABLE.parse(&(text + "c,b,1,x,-\n")).is_err());
    }

    #[test]
    fn two_per_cent_are_borne_and_no_more() {
        let known = [row("a", 10_000, 1_000, 500).figure()];
        let check = |flash, ram, stack| compare(&known, &[row("a", flash, ram, stack)], true);
        assert_eq!(check(10_200, 1_020, 510), Ok(()));
        assert_eq!(check(5_000, 500, 100), Ok(()));
        assert!(check(10_201, 1_000, 500).is_err());
        assert!(check(10_000, 1_021, 500).is_err());
        assert!(check(10_000, 1_000, 511).is_err());
    }

    #[test]
    fn new_and_lost_programs_and_missed_goals_are_named() {
        let (a, b) = (row("a", 1, 1, 1), row("b", 1, 1, 1));
        let fault = compare(&[a.figure()], std::slice::from_ref(&b), true).unwrap_err();
        assert!(fault.contains("b,b is not in the table"));
        assert!(fault.contains("a,b is no longer measured"));
        assert_eq!(compare(&[a.figure(), b.figure()], &[b], false), Ok(()));
        let mut big = row("c", ACTIVE_FLASH + SERIAL_FLASH, RAM, STACK);
        assert!(compare(&[big.figure()], &[big.clone()], true).is_err());
        big.has_serial = true;
        assert_eq!(compare(&[big.figure()], &[big], true), Ok(()));
        let mut big = row("c", ACTIVE_FLASH + 100, RAM + 1, STACK + 1);
        let fault = compare(&[big.figure()], &[big.clone()], true).unwrap_err();
        assert_eq!(fault.matches("goal").count(), 3, "{fault}");
        big.model = 100;
        let fault = compare(&[big.figure()], &[big.clone()], true).unwrap_err();
        assert_eq!(fault.matches("goal").count(), 2, "the model is apart");
        (big.heard, big.stack) = (2, STACK + STACK_MORE);
        let fault = compare(&[big.figure()], &[big.clone()], true).unwrap_err();
        assert_eq!(fault.matches("goal").count(), 1, "a classifier more");
        big.is_active = false;
        let fault = compare(&[big.figure()], &[big], true).unwrap_err();
        assert!(fault.contains(&format!("goal {PASSIVE_FLASH}")), "{fault}");
    }
}
