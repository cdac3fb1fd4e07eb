//! What each stage of a tick costs, beside its goal and what others take: from
//! the counts of `cargo xtask count` and from the emulated board. The table is
//! committed, so that no stage can become dearer unseen, and shown in
//! docs/measured/cost.md.

mod page;
mod reasons;
mod stages;

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use crate::run::{Fault, top};
use crate::{count, emulate, firmware};
use stages::{BOARD_STAGES, STAGES, Source};

/// The committed table.
const TABLE: &str = "docs/measured/cost.csv";

/// How the board keeps its time, over ten minutes.
const DEADLINES: &str = "docs/measured/deadlines.csv";

/// The page that shows both.
const PAGE: &str = "docs/measured/cost.md";

const HEADER: &str = "stage,target,mean,worst,goal,peer";

/// By how much a stage may become dearer before a check fails.
const SLACK: f64 = 0.05;

/// Minutes of the emulated board for the table.
const MINUTES: f64 = 0.25;

/// A line of the table.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Row {
    /// Stage, target.
    key: [String; 2],
    mean: f64,
    worst: f64,
    /// At most so many instructions, mean; where a second number follows, worst.
    goal: String,
    /// What others take, and who.
    peer: String,
}

/// Measures everything and prints it; writes the table to `csv` (or to the
/// committed one, and the page; `-`: prints the table alone), or checks that no
/// stage has become dearer than it says.
///
/// # Errors
/// If something cannot be built or run, or, checking, differs.
pub(crate) fn all(csv: Option<&Path>, check: bool) -> Result<(), Fault> {
    if check {
        count::all(None, true)?;
    }
    let rows = measured()?;
    if csv == Some(Path::new("-")) {
        print!("{}", table(&rows));
        return Ok(());
    }
    print!("{}", page::columns(&rows));
    let path = csv.map_or_else(|| top().join(TABLE), Path::to_owned);
    let wrong = |error| format!("{}: {error}", path.display());
    if check {
        let known = fs::read_to_string(&path).map_err(wrong)?;
        return compare(&read(&known)?, &rows);
    }
    fs::write(&path, table(&rows)).map_err(wrong)?;
    if csv.is_none() {
        write_page(false)?;
    }
    Ok(())
}

/// Ten minutes of the noisiest scene on the emulated board; writes
/// docs/measured/deadlines.csv and the page.
///
/// # Errors
/// If a tick is missed, or nothing can be built or run.
pub(crate) fn deadlines() -> Result<(), Fault> {
    let board = firmware::Board::named("nucleo-f446re")?;
    let said = emulate::deadlines(board, Path::new("scenes/full.toml"), 10.0)?;
    let path = top().join(DEADLINES);
    fs::write(&path, format!("what,mean,worst\n{said}"))
        .map_err(|error| format!("{}: {error}", path.display()))?;
    print!("{said}");
    write_page(false)
}

/// Writes docs/measured/cost.md from the committed tables, or checks that it is up to date.
///
/// # Errors
/// If a table is missing or, checking, the page differs.
pub(crate) fn write_page(check: bool) -> Result<(), Fault> {
    let text = |name: &str| {
        fs::read_to_string(top().join(name)).map_err(|error| format!("{name}: {error}"))
    };
    let page = page::page(
        &read(&text(TABLE)?)?,
        &text(DEADLINES)?,
        &text("docs/measured/sizes.csv")?,
    )?;
    let path = top().join(PAGE);
    if check {
        let there = text(PAGE)?;
        return if there == page {
            Ok(())
        } else {
            Err(format!("{PAGE} is out of date: cargo xtask docs"))
        };
    }
    fs::write(&path, page).map_err(|error| format!("{}: {error}", path.display()))
}

fn measured() -> Result<Vec<Row>, Fault> {
    let path: PathBuf = top().join("docs/measured/instructions.csv");
    let known =
        fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let counted = count::known(&known)?;
    let mut rows = Vec::new();
    for stage in STAGES {
        let (mut mean, mut worst) = (0.0, 0.0);
        for Source { kernel, sign } in stage.sources {
            let found = counted
                .iter()
                .find(|([k, f, p], ..)| k == kernel && f == stage.format && p == stage.processor);
            let (_, m, w) = found.ok_or_else(|| {
                format!(
                    "{kernel} in {} on {} is not counted",
                    stage.format, stage.processor
                )
            })?;
            mean += sign * m;
            worst += sign * w;
        }
        rows.push(stage.row(mean, worst));
    }
    let board = firmware::Board::named("nucleo-f446re")?;
    for stage in BOARD_STAGES {
        let said = emulate::deadlines(board, Path::new(stage.scene), MINUTES)?;
        for part in stage.parts {
            let [mean, worst] = page::figures(&said, part.what)?;
            rows.push(part.row(mean, worst));
        }
    }
    Ok(rows)
}

/// The table as it is committed.
fn table(rows: &[Row]) -> String {
    let mut text = format!("{HEADER}\n");
    for row in rows {
        let Row {
            key: [stage, target],
            mean,
            worst,
            goal,
            peer,
        } = row;
        let _ = writeln!(text, "{stage},{target},{mean:.1},{worst:.0},{goal},{peer}");
    }
    text
}

fn read(text: &str) -> Result<Vec<Row>, Fault> {
    let mut lines = text.lines();
    if lines.next() != Some(HEADER) {
        return Err(format!("{TABLE} does not begin with {HEADER}"));
    }
    let row = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        let [stage, target, mean, worst, goal, peer] = fields[..] else {
            return None;
        };
        Some(Row {
            key: [stage, target].map(str::to_owned),
            mean: mean.parse().ok()?,
            worst: worst.parse().ok()?,
            goal: goal.to_owned(),
            peer: peer.to_owned(),
        })
    };
    lines
        .map(|line| row(line).ok_or_else(|| format!("{TABLE} has a line {line:?}")))
        .collect()
}

/// Names every stage that is dearer than it was, new or gone.
fn compare(known: &[Row], found: &[Row]) -> Result<(), Fault> {
    let mut faults = String::new();
    for row in found {
        let name = row.key.join(" on ");
        let Some(was) = known.iter().find(|was| was.key == row.key) else {
            let _ = writeln!(faults, "{name} is not in the table");
            continue;
        };
        // A count of board and emulator has tenths that depend on the scene's end.
        let dearer = |now: f64, was: f64| now > was * (1.0 + SLACK) + 0.05;
        if dearer(row.mean, was.mean) || dearer(row.worst, was.worst) {
            let _ = writeln!(
                faults,
                "{name}: mean {:.1} was {:.1}, worst {:.0} was {:.0}",
                row.mean, was.mean, row.worst, was.worst
            );
        }
    }
    for was in known {
        if !found.iter().any(|row| row.key == was.key) {
            let _ = writeln!(faults, "{} is no longer measured", was.key.join(" on "));
        }
    }
    if faults.is_empty() {
        Ok(())
    } else {
        Err(format!(
            "{faults}If that is meant: cargo xtask cost, and commit {TABLE}"
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::{Row, compare, read, table};

    fn row(stage: &str, mean: f64, worst: f64) -> Row {
        Row {
            key: [stage, "m4f"].map(str::to_owned),
            mean,
            worst,
            goal: "24".to_owned(),
            peer: String::new(),
        }
    }

    #[test]
    fn a_table_is_read_back_as_it_was_written() {
        let rows = [row("drive", 21.0, 21.0), row("tick", 33.5, 40.0)];
        assert_eq!(read(&table(&rows)), Ok(rows.to_vec()));
        assert!(read("stage,mean\n").is_err());
    }

    #[test]
    fn five_per_cent_are_borne_and_no_more() {
        let known = [row("a", 100.0, 200.0)];
        assert_eq!(compare(&known, &[row("a", 105.0, 210.0)]), Ok(()));
        assert!(compare(&known, &[row("a", 105.2, 200.0)]).is_err());
        assert!(compare(&known, &[row("a", 100.0, 211.0)]).is_err());
        assert!(compare(&known, &[row("b", 1.0, 1.0)]).is_err());
    }
}
