//! The table of sizes: as it is committed, for a person to read, and compared.

use std::fmt::Write as _;

use crate::firmware::Size;
use crate::run::Fault;

/// The committed table, seen from the top of the workspace.
pub(super) const FILE: &str = "docs/measured/sizes.csv";

const HEADER: &str = "scene,board,flash_bytes,ram_bytes,stack_bytes";

/// By how much a program may grow before a check fails.
const SLACK: f64 = 0.02;

/// Goals, bytes: flash without the model for a passive and an active scene,
/// logging included; static RAM; stack.
const PASSIVE_FLASH: u64 = 8 * 1024;
const ACTIVE_FLASH: u64 = 24 * 1024;
const RAM: u64 = 4 * 1024;
const STACK: u64 = 1024;

/// What the firmware of a scene takes on a board.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Row {
    pub(super) scene: String,
    pub(super) board: String,
    pub(super) size: Size,
    /// Worst stack, where known.
    pub(super) stack: Option<u64>,
    // Not in the committed table:
    /// Bytes of flash that are the model.
    pub(super) model: u64,
    /// Whether it whisks.
    pub(super) is_active: bool,
    /// What host-sim takes a tick, where that was timed.
    pub(super) host_ns: Option<u64>,
}

/// A line of the committed table: scene, board, flash, RAM, stack.
type Line = ([String; 2], [Option<u64>; 3]);

impl Row {
    fn line(&self) -> Line {
        let bytes = [Some(self.size.flash), Some(self.size.ram), self.stack];
        ([self.scene.clone(), self.board.clone()], bytes)
    }

    fn missed_goals(&self) -> impl Iterator<Item = String> {
        let flash = if self.is_active {
            ACTIVE_FLASH
        } else {
            PASSIVE_FLASH
        };
        let goals = [
            (
                "flash without the model",
                self.size.flash - self.model,
                flash,
            ),
            ("static RAM", self.size.ram, RAM),
            ("stack", self.stack.unwrap_or(0), STACK),
        ];
        let place = format!("{} on {}", self.scene, self.board);
        goals
            .into_iter()
            .filter(|(_, found, goal)| found > goal)
            .map(move |(what, found, goal)| format!("{place}: {what} {found}, goal {goal}"))
    }
}

/// A number that may not be known.
fn text(bytes: Option<u64>) -> String {
    bytes.map_or_else(|| "-".to_owned(), |bytes| bytes.to_string())
}

/// The table as it is committed.
pub(super) fn csv(rows: &[Row]) -> String {
    let mut lines = format!("{HEADER}\n");
    for row in rows {
        let (key, bytes) = row.line();
        let _ = writeln!(lines, "{},{}", key.join(","), bytes.map(text).join(","));
    }
    lines
}

/// Reads the committed table.
///
/// # Errors
/// If it is none.
pub(super) fn read(text: &str) -> Result<Vec<Line>, Fault> {
    let mut lines = text.lines();
    if lines.next() != Some(HEADER) {
        return Err(format!("{FILE} does not begin with {HEADER}"));
    }
    let bytes = |field: &str| match field {
        "-" => Some(None),
        number => number.parse().ok().map(Some),
    };
    let line = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        let [scene, board, flash, ram, stack] = fields[..] else {
            return None;
        };
        let key = [scene, board].map(str::to_owned);
        Some((key, [bytes(flash)?, bytes(ram)?, bytes(stack)?]))
    };
    lines
        .map(|text| line(text).ok_or_else(|| format!("{FILE} has a line {text:?}")))
        .collect()
}

/// The table for a person to read, with what host-sim takes and what flash
/// would be without the model.
pub(super) fn columns(rows: &[Row]) -> String {
    let mut lines = format!(
        "{:<12} {:<14} {:>7} {:>14} {:>6} {:>6} {:>12}\n",
        "scene", "board", "flash", "without model", "RAM", "stack", "host ns/tick"
    );
    for row in rows {
        let _ = writeln!(
            lines,
            "{:<12} {:<14} {:>7} {:>14} {:>6} {:>6} {:>12}",
            row.scene,
            row.board,
            row.size.flash,
            row.size.flash - row.model,
            row.size.ram,
            text(row.stack),
            text(row.host_ns)
        );
    }
    lines
}

/// Names every program in `found` that has grown, is new or misses a goal; where
/// `found` `is_all`, also what is gone.
///
/// # Errors
/// If there is one.
pub(super) fn compare(known: &[Line], found: &[Row], is_all: bool) -> Result<(), Fault> {
    let mut faults: Vec<String> = found.iter().flat_map(Row::missed_goals).collect();
    for row in found {
        let (key, bytes) = row.line();
        let name = key.join(",");
        let Some((_, was)) = known.iter().find(|(known, _)| *known == key) else {
            faults.push(format!("{name} is not in the table"));
            continue;
        };
        let grown = bytes.iter().zip(was).any(|(now, was)| match (now, was) {
            (Some(now), Some(was)) => *now as f64 > *was as f64 * (1.0 + SLACK),
            (now, was) => now != was,
        });
        if grown {
            let [now, was] = [bytes, *was].map(|bytes| bytes.map(text).join(","));
            faults.push(format!("{name}: {now} was {was}"));
        }
    }
    for (key, _) in known {
        if is_all && !found.iter().any(|row| row.line().0 == *key) {
            faults.push(format!("{} is no longer built", key.join(",")));
        }
    }
    if faults.is_empty() {
        return Ok(());
    }
    faults.push(format!(
        "If that is meant: cargo xtask size, and commit {FILE}"
    ));
    Err(faults.join("\n"))
}

#[cfg(test)]
mod tests {
    use super::{Row, Size, compare, csv, read};

    fn row(scene: &str, flash: u64, ram: u64, stack: Option<u64>) -> Row {
        Row {
            scene: scene.to_owned(),
            board: "b".to_owned(),
            size: Size { flash, ram },
            stack,
            model: 0,
            is_active: true,
            host_ns: None,
        }
    }

    #[test]
    fn a_table_is_read_back_as_it_was_written() {
        let rows = [row("a", 10_000, 1_000, Some(500)), row("b", 1, 2, None)];
        let read_back = read(&csv(&rows)).unwrap();
        assert_eq!(read_back, rows.each_ref().map(Row::line));
        assert!(read("scene,board\n").is_err());
        assert!(read(&(csv(&rows) + "c,b,1,x,-\n")).is_err());
    }

    #[test]
    fn two_per_cent_are_borne_and_no_more() {
        let known = [row("a", 10_000, 1_000, Some(500)).line()];
        let check = |flash, ram, stack| compare(&known, &[row("a", flash, ram, stack)], true);
        assert_eq!(check(10_200, 1_020, Some(510)), Ok(()));
        assert_eq!(check(5_000, 500, Some(100)), Ok(()));
        assert!(check(10_201, 1_000, Some(500)).is_err());
        assert!(check(10_000, 1_021, Some(500)).is_err());
        assert!(check(10_000, 1_000, Some(511)).is_err());
        assert!(check(10_000, 1_000, None).is_err(), "no longer known");
    }

    #[test]
    fn new_and_lost_programs_and_missed_goals_are_named() {
        let (a, b) = (row("a", 1, 1, None), row("b", 1, 1, None));
        let fault = compare(&[a.line()], std::slice::from_ref(&b), true).unwrap_err();
        assert!(fault.contains("b,b is not in the table"));
        assert!(fault.contains("a,b is no longer built"));
        assert_eq!(compare(&[a.line(), b.line()], &[b], false), Ok(()));
        let mut big = row("c", 24 * 1024 + 100, 4 * 1024 + 1, Some(1_025));
        let fault = compare(&[big.line()], &[big.clone()], true).unwrap_err();
        assert_eq!(fault.matches("goal").count(), 3, "{fault}");
        big.model = 100;
        let fault = compare(&[big.line()], &[big.clone()], true).unwrap_err();
        assert_eq!(fault.matches("goal").count(), 2, "the model is apart");
        big.is_active = false;
        let fault = compare(&[big.line()], &[big], true).unwrap_err();
        assert!(fault.contains("goal 8192"));
    }
}
