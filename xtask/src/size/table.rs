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

/// The program that takes any scene, as it is called in the table.
pub(crate) const ANY_SCENE: &str = "any scene";

/// Goals for flash, bytes, scene and model apart, which the page shows met or missed.
const GOALS: [(&str, &str, u64); 4] = [
    ("passive", "nucleo-f446re", 19_000),
    ("passive", "nucleo-g071rb", 20_000),
    ("rcp", "nucleo-f446re", 30_000),
    ("bench", "nucleo-g071rb", 77_000),
];

/// Goal and limit of any program: what leaves 6 KiB of the smaller boards' 96.
const FLASH: u64 = 92_160;
/// Static RAM: settings, the next settings and both as bytes are 6 KiB of it.
const RAM: u64 = 14 * 1024;
/// Half a kilobyte less than the smaller boards have: idle decodes settings by pieces, and the
/// tick may come in between.
const STACK: u64 = 5632;

/// The limits in words.
pub(crate) fn limits() -> String {
    format!(
        "No program takes more than {FLASH} of flash, scene and model apart, {RAM} of static RAM\n\
         and {STACK} of stack, nor more than 2 % above what is committed: CI fails otherwise."
    )
}

/// The committed table as lines of a page, with the goals, and with the flash of the program that
/// takes any scene beside that of the scene's own.
pub(crate) fn beside_goals(csv: &str) -> Result<String, Fault> {
    let figures = TABLE.parse(csv)?;
    let mut lines = String::new();
    for figure in &figures {
        let [scene, board] = &figure.key[..] else {
            return Err(format!("{}: no scene and board", TABLE.file));
        };
        let (flash, any) = (figure.numbers[0], [ANY_SCENE.to_owned(), board.clone()]);
        let any = figures.iter().find(|figure| figure.key == any);
        let any = any.ok_or_else(|| format!("{}: {ANY_SCENE} on {board}?", TABLE.file))?;
        let any = any.numbers[0];
        let mut goals = GOALS.iter();
        let goal = goals.find(|(of, on, _)| (*of, *on) == (scene.as_str(), board.as_str()));
        let goal = goal.map_or_else(String::new, |(.., goal)| {
            let is_met = flash <= *goal as f64;
            format!("{goal} {}", if is_met { "met" } else { "**missed**" })
        });
        let (ram, stack) = (figure.numbers[1], figure.numbers[2]);
        let _ = writeln!(
            lines,
            "| {scene} | {board} | {flash} | {goal} | {any} | {ram} | {stack} |"
        );
    }
    Ok(lines)
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
    /// Bytes of flash that are the scene and its model.
    pub(super) scene_bytes: u64,
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

    fn beyond_limits(&self) -> impl Iterator<Item = String> {
        let limits = [
            ("flash", self.size.flash, FLASH),
            ("static RAM", self.size.ram, RAM),
            ("stack", self.stack, STACK),
        ];
        let place = format!("{} on {}", self.scene, self.board);
        limits
            .into_iter()
            .filter(|(_, found, limit)| found > limit)
            .map(move |(what, found, limit)| format!("{place}: {what} {found}, limit {limit}"))
    }
}

/// The table for a person to read, with what scene and model take and what host-sim takes.
pub(super) fn columns(rows: &[Row]) -> String {
    let mut lines = format!(
        "{:<12} {:<14} {:>7} {:>16} {:>6} {:>6} {:>12}\n",
        "scene", "board", "flash", "scene and model", "RAM", "stack", "host ns/tick"
    );
    for row in rows {
        let Size { flash, ram } = row.size;
        let host_ns = row
            .host_ns
            .map_or_else(|| "-".to_owned(), |ns| ns.to_string());
        let _ = writeln!(
            lines,
            "{:<12} {:<14} {flash:>7} {:>16} {ram:>6} {:>6} {host_ns:>12}",
            row.scene, row.board, row.scene_bytes, row.stack
        );
    }
    lines
}

/// Names every program in `found` that has grown, is new or exceeds a limit; where
/// `found` `is_all`, also what is gone.
pub(super) fn compare(known: &[Figure], found: &[Row], is_all: bool) -> Result<(), Fault> {
    let mut faults: Vec<String> = found.iter().flat_map(Row::beyond_limits).collect();
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
    use super::{ANY_SCENE, FLASH, GOALS, RAM, Row, STACK, Size, TABLE, beside_goals, compare};

    fn row(scene: &str, flash: u64, ram: u64, stack: u64) -> Row {
        Row {
            scene: scene.to_owned(),
            board: "b".to_owned(),
            size: Size { flash, ram },
            stack,
            scene_bytes: 0,
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
    fn new_and_lost_programs_and_those_beyond_a_limit_are_named() {
        let (a, b) = (row("a", 1, 1, 1), row("b", 1, 1, 1));
        let fault = compare(&[a.figure()], std::slice::from_ref(&b), true).unwrap_err();
        assert!(fault.contains("b,b is not in the table"));
        assert!(fault.contains("a,b is no longer measured"));
        assert_eq!(compare(&[a.figure(), b.figure()], &[b], false), Ok(()));
        let big = row("c", FLASH + 1, RAM + 1, STACK + 1);
        let fault = compare(&[big.figure()], std::slice::from_ref(&big), true).unwrap_err();
        assert_eq!(fault.matches("limit").count(), 3, "{fault}");
    }

    #[test]
    fn a_page_says_which_goals_are_met() {
        let (scene, board, goal) = GOALS[0];
        let head = TABLE.header;
        let line =
            |flash| format!("{head}\n{scene},{board},{flash},1,2\n{ANY_SCENE},{board},1,1,1\n");
        let met = |flash| beside_goals(&line(flash)).unwrap().contains("met");
        assert!(met(goal) && !met(goal + 1));
        assert!(beside_goals(&format!("{head}\n{scene},{board},1,1,2\n")).is_err());
    }
}
