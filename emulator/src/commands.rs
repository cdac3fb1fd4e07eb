//! The program: its commands, and what it prints of them.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Parser, Subcommand};
use host_sim::output::{self, write_whole};
use host_sim::progress::Verbosity;
use host_sim::{Error, report};

use crate::scenario::{self, Flashed, Given, Scenario, Several};
use crate::{campaign, counts, emulate, endurance, picture, registers, trial};

/// Runs a board's program, as it is flashed, on an emulated chip.
///
/// Exit status: 0 done, 1 the work failed, 2 the arguments or a file are wrong.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    /// No progress on standard error
    #[arg(long, global = true)]
    quiet: bool,

    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Runs one scene: writes DIR/trace.csv, DIR/log.txt, and DIR/decisions.csv
    /// where the scene classifies
    Run {
        #[command(flatten)]
        flashed: Flashed,
        /// Where to write
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
    },
    /// Puts a board through one of the scenarios; fails if something is not as it should be
    Scenario {
        /// Which
        #[arg(value_parser = scenarios())]
        scenario: &'static Scenario,
        #[command(flatten)]
        given: Given,
    },
    /// Runs one scene against what befalls it, as a file lists it, and writes what became of it
    Try(trial::Choice),
    /// Draws what both sides do in scenes with obstacles, one below the other
    Picture {
        #[command(flatten)]
        several: Several,
        /// The SVG file to write
        #[arg(long, value_name = "FILE")]
        out: PathBuf,
    },
    /// Counts the instructions of the kernels that the program of xtask/count calls: prints a
    /// kernel, its format, mean and worst a line
    Count {
        /// The program
        program: PathBuf,
        /// The board whose core executes it
        #[arg(long)]
        board: String,
    },
    /// Injects faults at random into running scenes and writes a row a run
    Campaign(campaign::Choice),
    /// Prints what drivers and emulated chips take from the chips' manuals, as the page of it
    Facts {
        /// That of one board, a line a fact
        #[arg(long)]
        board: Option<String>,
    },
    /// Makes the page of the campaign from its tables; fails if a run was harmful
    Reliability {
        /// The tables of all shards
        #[arg(required = true)]
        tables: Vec<PathBuf>,
        /// The page to write; none: only harmful runs are named
        #[arg(long, value_name = "FILE")]
        out: Option<PathBuf>,
    },
    /// Runs a scene for hours and writes a row: on the PC, or, with a program, on a board whose
    /// counters start just below their wraps
    Endure(endurance::Choice),
    /// Makes the page of the long runs from the files of all shards
    Endurance {
        /// The files
        #[arg(required = true)]
        shards: Vec<PathBuf>,
        /// The page to write
        #[arg(long, value_name = "FILE")]
        out: PathBuf,
    },
}

fn scenarios() -> impl TypedValueParser<Value = &'static Scenario> {
    let name = |scenario: &Scenario| PossibleValue::new(scenario.name).help(scenario.what);
    PossibleValuesParser::new(scenario::ALL.iter().map(name)).try_map(|name| {
        let mut all = scenario::ALL.iter();
        all.find(|scenario| scenario.name == name)
            .ok_or("no such scenario")
    })
}

fn work(arguments: Arguments) -> Result<(), Error> {
    let verbosity = Verbosity::of(arguments.quiet);
    match arguments.command {
        Command::Run { flashed, out } => {
            let Flashed { scene, program } = flashed;
            if let Some(summary) = emulate::emulate(&scene, &program, &out, verbosity)? {
                report::say(summary);
            }
        }
        Command::Scenario {
            scenario,
            mut given,
        } => {
            given.verbosity = verbosity;
            report::say(scenario.run(&given)?.join("\n"));
        }
        Command::Picture { several, out } => {
            output::check(&out)?;
            write_whole(&out, picture::picture(&several)?.as_bytes())?;
        }
        Command::Try(choice) => choice.run()?,
        Command::Campaign(choice) => choice.run()?,
        Command::Endure(choice) => choice.run()?,
        Command::Endurance { shards, out } => endurance::write_page(&shards, &out)?,
        Command::Reliability { tables, out } => {
            report::say(campaign::reliability(&tables, out.as_deref())?);
        }
        Command::Count { program, board } => report::say(counts::count(&program, &board)?),
        Command::Facts { board: None } => report::say(registers::page().trim_end()),
        Command::Facts { board: Some(board) } => report::say(registers::table(&board)?.trim_end()),
    }
    Ok(())
}

/// Does what its arguments say, and says what came of it.
pub fn main() -> ExitCode {
    report::program("emulator", || work(Arguments::parse()))
}
