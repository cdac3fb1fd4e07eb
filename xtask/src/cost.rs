//! What each stage of a tick costs, beside its goal and what others take: from
//! the counts of `cargo xtask count` and from the emulated board. The table is
//! committed and shown in docs/measured/cost.md.

mod page;
mod stages;

use std::path::Path;

use crate::figures::{Figure, INSTRUCTIONS, Table};
use crate::run::{Fault, document, read, top, write};
use crate::{count, emulate, firmware, size};
use stages::{Stage, stages};

const TABLE: Table = Table {
    file: "docs/measured/cost.csv",
    header: "stage,target,mean,worst",
    decimals: INSTRUCTIONS,
    slack: 0.05,
    command: "cargo xtask cost",
};

/// How the board keeps its time, over ten minutes.
const DEADLINES: &str = "docs/measured/deadlines.csv";

const PAGE: &str = "docs/measured/cost.md";

/// Minutes of the emulated board for the table.
const MINUTES: f64 = 0.25;

/// Measures everything and writes the table (to `csv`, where one is named) and the
/// page; or counts again and checks that no kernel and no stage has become dearer.
pub(crate) fn all(csv: Option<&Path>, check: bool) -> Result<(), Fault> {
    if check {
        count::all(None, true)?;
    }
    let mut found = Vec::new();
    for group in stages()?.chunk_by(Stage::goes_with) {
        found.extend(measured(group)?);
    }
    TABLE.take(&found, csv, check)?;
    if check || csv.is_some() {
        return Ok(());
    }
    write_page(false)
}

pub(crate) fn short() -> Result<(), Fault> {
    let stages = stages()?;
    let mut scenes = stages.chunk_by(Stage::goes_with);
    let first = scenes.find(|group| group[0].is_on_board());
    let first = first.ok_or("no stage is measured on the board")?;
    TABLE.check_part(&measured(first)?)
}

pub(crate) fn deadlines() -> Result<(), Fault> {
    let board = firmware::Board::named("nucleo-f446re")?;
    let said = emulate::deadlines(board, Path::new("scenes/full.toml"), 10.0)?;
    write(&top().join(DEADLINES), format!("what,mean,worst\n{said}"))?;
    print!("{said}");
    write_page(false)
}

/// Writes docs/measured/cost.md from the committed tables, or checks that it is up to date.
pub(crate) fn write_page(check: bool) -> Result<(), Fault> {
    let deadlines = read(&top().join(DEADLINES))?;
    let page = page::page(&TABLE.read(None)?, &deadlines, &size::TABLE.read(None)?)?;
    document(PAGE, page.as_bytes(), check)
}

/// Some stages: of one processor, which the committed counts of kernels add up to, or of
/// one scene on the board.
fn measured(stages: &[Stage]) -> Result<Vec<Figure>, Fault> {
    let first = &stages[0];
    let figure = |stage: &Stage, [mean, worst]: [f64; 2]| {
        let mut figure = Figure::instructions(&[&stage.name, &stage.target], mean, worst);
        figure.note = page::note(stage, &figure.numbers);
        figure
    };
    if first.is_on_board() {
        let board = firmware::Board::named(&first.target)?;
        let said = emulate::deadlines(board, Path::new(&first.from), MINUTES)?;
        let found = |stage: &Stage| Ok(figure(stage, page::figures(&said, &stage.counts)?));
        return stages.iter().map(found).collect();
    }
    let counted = count::TABLE.read(None)?;
    let figures = stages.iter().map(|stage| {
        let mut sums = [0.0; 2];
        for (kernel, sign) in stage.kernels() {
            let key = [kernel, &stage.format, &stage.from];
            let found = counted.iter().find(|figure| *figure.key == key);
            let found = found.ok_or_else(|| format!("{} is not counted", key.join(",")))?;
            sums = [0, 1].map(|n| sums[n] + sign * found.numbers[n]);
        }
        Ok(figure(stage, sums))
    });
    figures.collect()
}
