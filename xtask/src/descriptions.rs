//! The facts that drivers and emulated chips take from the chips' manuals: their page, and
//! whether stm32-metapac, made by others, says the same.

use std::io::Write as _;
use std::process::Stdio;

use crate::firmware::Board;
use crate::run::{Fault, cargo_apart, document, emulator, output};

const PAGE: &str = "docs/registers.md";

fn facts(board: Option<Board>) -> Result<String, Fault> {
    let mut command = emulator("facts");
    if let Some(board) = board {
        command.args(["--board", board.name]);
    }
    output(&mut command)
}

pub(crate) fn page(check: bool) -> Result<(), Fault> {
    document(PAGE, facts(None)?.as_bytes(), check)
}

/// Holds every fact of every board against the description of its chip.
pub(crate) fn compare() -> Result<(), Fault> {
    Board::ALL.into_iter().try_for_each(of_board)
}

/// By a program that is built for the chip alone (`description`).
fn of_board(board: Board) -> Result<(), Fault> {
    let facts = facts(Some(board))?;
    let mut command = cargo_apart("run", "description", "description");
    command
        .args(["--features", board.name])
        .stdin(Stdio::piped());
    let wrong = |error: std::io::Error| format!("{}: {error}", board.name);
    let mut described = command.spawn().map_err(wrong)?;
    if let Some(mut stdin) = described.stdin.take() {
        stdin.write_all(facts.as_bytes()).map_err(wrong)?;
    }
    if described.wait().map_err(wrong)?.success() {
        Ok(())
    } else {
        Err(format!("{}: not as described", board.name))
    }
}
