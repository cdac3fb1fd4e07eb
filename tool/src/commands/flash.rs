//! `whisker flash`: a scene's program onto a board.

use std::path::PathBuf;

use clap::Args;
use host_sim::Error;
use host_sim::progress::Verbosity;

use crate::conversation::Conversation;
use crate::probe;
use crate::source::{BoardName, Laying, build, is_of, with_scene};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The scene whose program is built and flashed, or that --program is to bring with it
    #[arg(required_unless_present = "program")]
    scene: Option<PathBuf>,
    /// A program that was built before, for any scene; with SCENE it brings that one with it
    #[arg(long, value_name = "ELF")]
    program: Option<PathBuf>,
    /// The board
    #[arg(long, value_enum, default_value = "nucleo-f446re")]
    board: BoardName,
    /// Where there are several probes, the one whose serial number begins so
    #[arg(long, value_name = "SERIAL", default_value = "")]
    probe: String,
    /// Leaves an F446's brown-out level as it is; otherwise it is set to level 3, where it is lower
    #[arg(long)]
    keep_brown_out: bool,
    /// Prints the board's log afterwards, until interrupted
    #[arg(long)]
    log: bool,
}

pub(crate) fn flash(arguments: &Arguments, verbosity: Verbosity) -> Result<(), Error> {
    let Arguments { board, probe, .. } = arguments;
    if let Some(program) = &arguments.program {
        is_of(program, Some(*board))?;
    }
    // What cannot be flashed need not be built.
    probe::is_there(probe)?;
    let copy;
    let elf = match (&arguments.program, &arguments.scene) {
        (Some(program), Some(scene)) => {
            copy = with_scene(*board, program, scene)?;
            copy.path().to_owned()
        }
        (Some(program), None) => program.clone(),
        (None, Some(scene)) => build(*board, scene)?,
        (None, None) => return Err(Error::Input("SCENE is missing".to_owned())),
    };
    probe::flash(probe, *board, &elf, arguments.keep_brown_out, verbosity)?;
    if arguments.log {
        let mut module =
            Conversation::new(probe::open(probe, *board, Some(&elf), Laying::by(None))?);
        // Until interrupted.
        module.print_log(f64::INFINITY)?;
    }
    Ok(())
}
