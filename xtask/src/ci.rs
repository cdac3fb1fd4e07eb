//! What CI checks, in the order in which it is quickest to fail.

use std::path::Path;

use crate::run::{Fault, cargo, run};
use crate::{count, docs, firmware};

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
        for scene in [
            "scenes/passive.toml",
            "scenes/rcp-left.toml",
            "scenes/textures.toml",
        ] {
            let scene = Path::new(scene);
            let elf = firmware::build(board, scene)?;
            firmware::print_size(board, scene, &elf)?;
        }
    }

    run(&mut cargo(&["test", "-p", "count", "--lib"]))?;
    count::all(None, true)?;

    // What the README tells a newcomer to run: the main job (its output and its
    // files are what the generated documents must hold), then all tests.
    docs::all(true)?;
    run(&mut cargo(&["test"]))
}
