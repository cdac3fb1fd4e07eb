//! The command line. `studies --help` documents it.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use host_sim::Error;
use host_sim::progress::Verbosity;
use host_sim::report::{program, say};
use studies::accuracy::LongRun;
use studies::commands::experiment::{self, Options};
use studies::commands::{decisions, report};
use studies::decisions::Extent;
use studies::experiment::Name;

/// The laboratory: the papers' experiments on simulated rigs, the accuracy report, and
/// what decisions are worth.
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
    /// Runs the experiments of the papers on simulated rigs and writes
    /// DIR/experiments.md with tables and figures beside the papers'
    Experiment {
        #[command(subcommand)]
        which: Which,
    },
    /// Measures the accuracy of every integrator, number format and function
    /// and writes DIR/accuracy.md with its pictures
    Report {
        /// Where documents are: instructions.csv is read, the report written there
        #[arg(long, value_name = "DIR", default_value = "docs/measured")]
        out: PathBuf,
        /// Run ten minutes in place of showing the kept 24 hours
        #[arg(long)]
        quick: bool,
        /// Run the 24 hours anew and keep them (DIR/accuracy/long-run.csv)
        #[arg(long, conflicts_with = "quick")]
        long: bool,
        /// Only say whether the report is up to date
        #[arg(long, conflicts_with_all = ["quick", "long"])]
        check: bool,
    },
    /// Measures what decisions are worth and writes DIR/decisions.md with its table and
    /// pictures
    Decisions {
        /// Where documents are: instructions.csv is read, the page written there
        #[arg(long, value_name = "DIR", default_value = "docs/measured")]
        out: PathBuf,
        /// Where the recordings of terrain are
        #[arg(long, value_name = "DIR", default_value = "tests/data/terrain")]
        terrain: PathBuf,
        /// Fewer runs, trainings and settings
        #[arg(long)]
        quick: bool,
        /// Only say whether the page is up to date
        #[arg(long, conflicts_with = "quick")]
        check: bool,
    },
}

#[derive(Subcommand)]
enum Which {
    /// LEP10: naive Bayes over fixed windows, on four floors
    Lep10(Options),
    /// LEP12: sequential Bayes, spectral template and neural network, on four floors
    Lep12(Options),
    /// BIOTACT: six whisking whiskers, with and without RCP
    Biotact(Options),
    /// POSE: one contact at an unknown angle and speed
    Pose(Options),
    /// PSIK: 33 vibrissae, sandpapers and corridors
    Psikharpax(Options),
    /// All of them
    All(Options),
}

impl Which {
    fn work(self, verbosity: Verbosity) -> Result<String, Error> {
        let (names, options) = match self {
            Self::Lep10(options) => (vec![Name::Lep10], options),
            Self::Lep12(options) => (vec![Name::Lep12], options),
            Self::Biotact(options) => (vec![Name::Biotact], options),
            Self::Pose(options) => (vec![Name::Pose], options),
            Self::Psikharpax(options) => (vec![Name::Psikharpax], options),
            Self::All(options) => (Name::ALL.to_vec(), options),
        };
        experiment::experiment(names, &options, verbosity)
    }
}

fn work(arguments: Arguments) -> Result<(), Error> {
    let verbosity = Verbosity::of(arguments.quiet);
    say(match arguments.command {
        Command::Experiment { which } => which.work(verbosity)?,
        Command::Report {
            out,
            quick,
            long,
            check,
        } => {
            let long_run = match (long, quick) {
                (true, _) => LongRun::Anew,
                (false, true) => LongRun::Quick,
                (false, false) => LongRun::Kept,
            };
            report::report(&out, long_run, check, verbosity)?
        }
        Command::Decisions {
            out,
            terrain,
            quick,
            check,
        } => {
            let extent = if quick {
                Extent::quick()
            } else {
                Extent::full()
            };
            decisions::decisions(&out, &terrain, &extent, check, verbosity)?
        }
    });
    Ok(())
}

fn main() -> ExitCode {
    program("studies", || work(Arguments::parse()))
}
