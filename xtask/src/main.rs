//! Everything CI does, by name: `cargo xtask ci`, `firmware`, `flash`, `docs`.

mod ci;
mod count;
mod docs;
mod firmware;
mod mutants;
mod run;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

#[derive(Parser)]
#[command(about = "Everything CI does, by name")]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// All that CI checks: format, lints, generated documents, the firmware
    /// build, the main job, all tests
    Ci,
    /// Builds the firmware of a scene and prints its flash and RAM bytes
    Firmware(Build),
    /// Builds the firmware of a scene, flashes it and streams its log
    /// (needs probe-rs and a board)
    Flash(Build),
    /// Counts the instructions of every kernel on emulated processors
    /// (needs qemu-system-arm) and writes docs/instructions.csv
    Count {
        /// The table to write or to check
        #[arg(long)]
        csv: Option<PathBuf>,
        /// Only say whether a kernel has become dearer than the table says
        #[arg(long)]
        check: bool,
    },
    /// Leaves out one term of an equation or turns round one bit of a table at
    /// a time, and writes which tests notice to docs/mutations.md (takes hours)
    Mutants {
        /// Only those whose description contains this; writes no document
        #[arg(long)]
        only: Option<String>,
    },
    /// Writes the generated documents anew
    Docs {
        /// Only say whether they are up to date
        #[arg(long)]
        check: bool,
    },
}

#[derive(clap::Args)]
struct Build {
    /// The scene to build; the default is the main job's
    #[arg(long, default_value = "scenes/textures.toml")]
    scene: PathBuf,
    /// The board to build for
    #[arg(long, default_value = "nucleo-f446re", value_parser = firmware::Board::named)]
    board: firmware::Board,
}

fn main() -> ExitCode {
    let done = match Arguments::parse().command {
        Command::Ci => ci::all(),
        Command::Firmware(build) => firmware::build(build.board, &build.scene)
            .and_then(|elf| firmware::print_size(build.board, &build.scene, &elf)),
        Command::Flash(build) => firmware::build(build.board, &build.scene)
            .and_then(|elf| firmware::flash(build.board, &elf)),
        Command::Count { csv, check } => count::all(csv.as_deref(), check),
        Command::Mutants { only } => mutants::all(only.as_deref()),
        Command::Docs { check } => docs::all(check),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(fault) => {
            eprintln!("xtask: {fault}");
            ExitCode::FAILURE
        }
    }
}
