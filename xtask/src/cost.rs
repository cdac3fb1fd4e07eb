//! What each stage of a tick costs, beside its goal and what others take: from
//! the counts of `cargo xtask count` and from the emulated board. The table is
//! committed and shown in docs/measured/cost.md.

mod page;
mod reasons;
mod stages;

use std::fs;
use std::path::Path;

use crate::figures::{Figure, Table, columns};
use crate::run::{Fault, top};
use crate::{count, emulate, firmware};
use stages::{BOARD_STAGES, BoardStage, STAGES, Source};

/// The committed table.
const TABLE: Table = Table {
    file: "docs/measured/cost.csv",
    header: "stage,target,mean,worst",
    command: "cargo xtask cost",
};

/// How the board keeps its time, over ten minutes.
const DEADLINES: &str = "docs/measured/deadlines.csv";

/// The page that shows both.
const PAGE: &str = "docs/measured/cost.md";

/// Minutes of the emulated board for the table.
const MINUTES: f64 = 0.25;

/// Measures everything and writes the table (to `csv`, where one is named) and the
/// page; or counts anew and checks that no kernel and no stage has become dearer.
///
/// # Errors
/// If something cannot be built or run, or, checking, differs.
pub(crate) fn all(csv: Option<&Path>, check: bool) -> Result<(), Fault> {
    if check {
        count::all(None, true)?;
    }
    let mut found = computed()?;
    for stage in BOARD_STAGES {
        found.extend(on_board(stage)?);
    }
    if check {
        print!("{}", columns(&found, page::note));
        return TABLE.compare(&TABLE.read(csv)?, &found, true);
    }
    TABLE.write(&found, csv, page::note)?;
    match csv {
        Some(_) => Ok(()),
        None => write_page(false),
    }
}

/// Checks the first scene that is measured on the board.
///
/// # Errors
/// As [`all`].
pub(crate) fn short() -> Result<(), Fault> {
    let found = on_board(&BOARD_STAGES[0])?;
    print!("{}", columns(&found, page::note));
    TABLE.compare(&TABLE.read(None)?, &found, false)
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

/// Writes docs/measured/cost.md from the committed tables, or checks that it is up
/// to date.
///
/// # Errors
/// If a table is missing or, checking, the page differs.
pub(crate) fn write_page(check: bool) -> Result<(), Fault> {
    let text = |name: &str| {
        fs::read_to_string(top().join(name)).map_err(|error| format!("{name}: {error}"))
    };
    let sizes = text("docs/measured/sizes.csv")?;
    let page = page::page(&TABLE.read(None)?, &text(DEADLINES)?, &sizes)?;
    if !check {
        return fs::write(top().join(PAGE), page).map_err(|error| format!("{PAGE}: {error}"));
    }
    if text(PAGE)? == page {
        Ok(())
    } else {
        Err(format!("{PAGE} is out of date: cargo xtask docs"))
    }
}

/// What the committed counts of kernels add up to.
fn computed() -> Result<Vec<Figure>, Fault> {
    let counted = count::TABLE.read(None)?;
    let mut figures = Vec::new();
    for stage in STAGES {
        let (mut mean, mut worst) = (0.0, 0.0);
        for Source { kernel, sign } in stage.sources {
            let key = [kernel, stage.format, stage.processor];
            let found = counted.iter().find(|figure| figure.key == key);
            let found = found.ok_or_else(|| format!("{} is not counted", key.join(",")))?;
            mean += sign * found.mean;
            worst += sign * found.worst;
        }
        figures.push(Figure::new(&[stage.name, stage.target], mean, worst));
    }
    Ok(figures)
}

fn on_board(stage: &BoardStage) -> Result<Vec<Figure>, Fault> {
    let board = firmware::Board::named("nucleo-f446re")?;
    let said = emulate::deadlines(board, Path::new(stage.scene), MINUTES)?;
    let figure = |&(what, name): &(&str, &str)| {
        let [mean, worst] = page::figures(&said, what)?;
        Ok(Figure::new(&[name, board.name], mean, worst))
    };
    stage.parts.iter().map(figure).collect()
}
