//! The table of sizes, its limits and its goals.

use crate::figures::{Figure, Table};
use crate::firmware::Board;
use crate::run::{Fault, no_faults};

pub(crate) const TABLE: Table = Table {
    file: "docs/measured/sizes.csv",
    header: "scene,board,flash_bytes,ram_bytes,stack_bytes",
    decimals: &[0; 3],
    slack: 0.02,
    command: "cargo xtask size",
};

/// The program that takes any scene, as it is called in the table.
pub(crate) const ANY_SCENE: &str = "any scene";

/// Goals for flash, bytes, scene and model apart, which the page shows met or missed. Those of
/// programs that are silent, without telemetry, are the same: what is above them is the link.
const GOALS: [(&str, &str, u64); 7] = [
    ("passive", "nucleo-f446re", 19_000),
    ("passive", "nucleo-g071rb", 20_000),
    ("rcp", "nucleo-f446re", 30_000),
    ("bench", "nucleo-g071rb", 77_000),
    ("passive-silent", "nucleo-f446re", 19_000),
    ("passive-silent", "nucleo-g071rb", 20_000),
    ("rcp-silent", "nucleo-f446re", 30_000),
];

/// Goal and limit of any program: the smaller boards' 104 KiB. It was 92,160 before stops were looked
/// for where bytes arrive, motors held against a model, homing knew the travel, names were
/// checked on the board too, gains and limits had bounds there, and scenes armed motors but
/// once, which took 10 KB.
const FLASH: u64 = 106_496;
/// Static RAM: settings, the next settings and both as bytes are 6 KiB of it, second opinions of
/// two whiskers 1.2 KiB.
const RAM: u64 = 15 * 1024;
/// Half a kilobyte less than the smaller boards have: idle decodes settings by pieces, and the
/// tick may come in between.
const STACK: u64 = 5632;

pub(crate) fn limits() -> String {
    format!(
        "No program but that for any scene on the NUCLEO-F446RE takes more than {FLASH} of flash, scene\n\
         and model apart, {RAM} of static RAM and {STACK} of stack, nor more than 2 % above what is committed: CI fails otherwise."
    )
}

/// The committed table as lines of a page, with the goals, and with the flash of the program that
/// takes any scene beside that of the scene's own.
pub(crate) fn beside_goals(figures: &[Figure]) -> Result<String, Fault> {
    let line = |figure: &Figure| {
        let [scene, board] = &figure.key[..] else {
            return Err(format!("{}: no scene and board", TABLE.file));
        };
        let any = figures
            .iter()
            .find(|figure| figure.key == [ANY_SCENE, board]);
        let any = any.ok_or_else(|| format!("{}: {ANY_SCENE} on {board}?", TABLE.file))?;
        let (flash, any) = (figure.numbers[0], any.numbers[0]);
        let mut goals = GOALS.iter();
        let goal = goals.find(|(of, on, _)| (*of, *on) == (scene.as_str(), board.as_str()));
        let goal = goal.map_or_else(String::new, |(.., goal)| {
            let is_met = flash <= *goal as f64;
            format!("{goal} {}", if is_met { "met" } else { "**missed**" })
        });
        let (ram, stack) = (figure.numbers[1], figure.numbers[2]);
        Ok(format!(
            "| {scene} | {board} | {flash} | {goal} | {any} | {ram} | {stack} |"
        ))
    };
    let lines: Result<Vec<String>, Fault> = figures.iter().map(line).collect();
    Ok(lines?.join("\n"))
}

pub(super) fn within_limits(found: &[Figure]) -> Result<(), Fault> {
    let limits = [("flash", FLASH), ("static RAM", RAM), ("stack", STACK)];
    let mut faults = Vec::new();
    // What only the board with 512 KiB takes.
    let largest = [ANY_SCENE, Board::ALL[0].name];
    let small = found.iter().filter(|figure| *figure.key != largest);
    for Figure { key, numbers, .. } in small {
        for ((what, limit), number) in limits.iter().zip(numbers) {
            if *number > *limit as f64 {
                let place = key.join(" on ");
                faults.push(format!("{place}: {what} {number}, limit {limit}"));
            }
        }
    }
    no_faults(&faults)
}

#[cfg(test)]
mod tests {
    use super::{ANY_SCENE, FLASH, GOALS, RAM, STACK, beside_goals, within_limits};
    use crate::figures::Figure;

    #[test]
    fn programs_beyond_a_limit_are_named() {
        let limits = [FLASH, RAM, STACK].map(|limit| limit as f64);
        let program = |more: f64| Figure::new(&["c", "b"], &limits.map(|limit| limit + more));
        assert_eq!(within_limits(&[program(0.0)]), Ok(()));
        let fault = within_limits(&[program(1.0)]).unwrap_err();
        assert_eq!(fault.matches("limit").count(), 3, "{fault}");
    }

    #[test]
    fn a_page_says_which_goals_are_met() {
        let (scene, board, goal) = GOALS[0];
        let program = |scene, flash: u64| Figure::new(&[scene, board], &[flash as f64, 1.0, 2.0]);
        let met = |flash| {
            let lines = beside_goals(&[program(scene, flash), program(ANY_SCENE, 1)]);
            lines.unwrap().contains("met")
        };
        assert!(met(goal) && !met(goal + 1));
        assert!(beside_goals(&[program(scene, goal)]).is_err());
    }
}
