//! What CI checks, in the order in which it is quickest to fail.

use std::path::Path;

use crate::emulate::Task;
use crate::run::{Fault, cargo, run, target};
use crate::{cost, docs, emulate, firmware, size};

/// Everything.
///
/// # Errors
/// The first check that fails.
pub(crate) fn all() -> Result<(), Fault> {
    run(&mut cargo(&["fmt", "--all", "--check"]))?;
    let deny = ["--", "-D", "warnings"];
    let lints = ["clippy", "--workspace", "--all-targets", "--all-features"];
    run(cargo(&lints).args(deny))?;

    for board in firmware::Board::ALL {
        run(cargo(&["clippy"]).args(board.build_arguments()).args(deny))?;
    }
    // Builds every scene for every board.
    size::all(None, true)?;

    // The same binary on the emulated chip: PC and board agree, no tick is missed,
    // and ticks that are too long and a sensor that is lost are noticed.
    for board in firmware::Board::ALL {
        if board.is_emulated() {
            emulate::compare_all(board)?;
            let scene = Path::new("scenes/full.toml");
            emulate::emulate(board, scene, &Task::Deadlines(0.25))?;
            emulate::emulate(board, scene, &Task::Overload)?;
            emulate::emulate(board, scene, &Task::SensorLoss)?;
        }
    }

    run(&mut cargo(&["test", "-p", "count", "--lib"]))?;
    // Counts anew what docs/measured/instructions.csv and docs/measured/cost.csv say.
    cost::all(None, true)?;

    // What the README tells a newcomer to run: the main job (its output and its
    // files are what the generated documents must hold), then all tests.
    docs::all(true)?;
    // Every experiment of the papers, cut short.
    let experiments = ["run", "--release", "--quiet", "-p", "studies", "--"];
    let quick = ["--quiet", "experiment", "all", "--quick", "--out"];
    let out = target().join("experiments");
    run(cargo(&experiments).args(quick).arg(out))?;
    run(&mut cargo(&["test"]))
}
