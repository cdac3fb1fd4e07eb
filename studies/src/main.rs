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
        /// Which, or all of them
        #[arg(value_enum, required = true)]
        which: Vec<Which>,
        #[command(flatten)]
        options: Options,
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

/// Experiments by the names of their papers.
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Which {
    /// LEP10: naive Bayes over fixed windows, on four floors
    Lep10,
    /// LEP12: sequential Bayes, spectral template and neural network, on four floors
    Lep12,
    /// BIOTACT: six whisking whiskers, with and without RCP
    Biotact,
    /// POSE: one contact at an unknown angle and speed
    Pose,
    /// PSIK: 33 vibrissae, sandpapers and corridors
    Psikharpax,
    /// All of them
    All,
}

/// The experiments, each once, in the order of the page.
fn names(which: &[Which]) -> Vec<Name> {
    let is_meant = |name: &Name| {
        let own = match name {
            Name::Lep10 => Which::Lep10,
            Name::Lep12 => Which::Lep12,
            Name::Biotact => Which::Biotact,
            Name::Pose => Which::Pose,
            Name::Psikharpax => Which::Psikharpax,
        };
        which.contains(&own) || which.contains(&Which::All)
    };
    Name::ALL.into_iter().filter(is_meant).collect()
}

fn work(arguments: Arguments) -> Result<(), Error> {
    let verbosity = Verbosity::of(arguments.quiet);
    say(match arguments.command {
        Command::Experiment { which, options } => {
            experiment::experiment(names(&which), &options, verbosity)?
        }
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
