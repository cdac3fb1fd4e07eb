//! The laboratory: the papers' experiments on simulated rigs with their classifiers, the report of
//! how accurate the numerics are, and the pages of what decisions are worth. Nothing that a board or
//! a simulated scene runs depends on it. `studies --help` documents the command line.

mod accuracy;
mod chart;
mod classifiers;
mod cores;
mod decisions;
mod experiment;
mod moments;
mod page;
mod paper;
mod poses;
mod rigs;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use clap::{Parser, Subcommand};
use host_sim::Error;
use host_sim::output::write_whole;
use host_sim::progress::Verbosity;
use host_sim::report::{program, say};

use accuracy::LongRun;
use decisions::Folders;
use experiment::Asked;
use page::Files;

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
    Experiment(Asked),
    /// Measures the accuracy of every integrator and number format and writes
    /// DIR/accuracy.md with its pictures
    Report {
        /// Where documents are: instructions.csv is read, the report written there
        #[arg(long, value_name = "DIR", default_value = "docs/measured")]
        out: PathBuf,
        /// Run ten minutes in place of showing the kept 24 hours
        #[arg(long)]
        quick: bool,
        /// Run the 24 hours and keep them (DIR/accuracy/long-run.csv)
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
    /// Measures what decisions are worth where use differs from training and writes
    /// DIR/poses.md with its table
    Poses {
        /// Where documents are: the page is written there
        #[arg(long, value_name = "DIR", default_value = "docs/measured")]
        out: PathBuf,
        /// Fewer trainings, conditions and presentations
        #[arg(long)]
        quick: bool,
        /// Only say whether the page is up to date
        #[arg(long, conflicts_with = "quick")]
        check: bool,
    },
}

/// Runs experiments. Writes the page, its pictures and, where asked for, their data. Returns what
/// was done.
fn experiments(asked: &Asked, verbosity: Verbosity) -> Result<String> {
    let write = |folder: &Path, files: &Files| {
        let mut all = files.iter();
        all.try_for_each(|(name, text)| Ok(write_whole(&folder.join(name), text.as_bytes())?))
    };
    let mut keep = |data: &Files| match &asked.data {
        Some(folder) => write(folder, data),
        None => Ok(()),
    };
    let mut page = String::new();
    experiment::run(asked, verbosity, &mut keep, &mut |files| {
        page = files
            .last()
            .map_or_else(String::new, |(name, _)| name.clone());
        write(&asked.out, files)
    })?;
    Ok(asked.out.join(page).display().to_string())
}

/// Writes generated files into the folder `out`, or with `check` says whether those that are there
/// are the same. `command` makes `what`. Returns what was done.
fn keep(out: &Path, files: &Files, check: bool, what: &str, command: &str) -> Result<String> {
    let folder = out.display();
    if !check {
        for (name, text) in files {
            write_whole(&out.join(name), text.as_bytes())?;
        }
        return Ok(format!("{folder}: {} files of {what}", files.len()));
    }
    let differs = |(name, text): &&(String, String)| {
        std::fs::read(out.join(name)).map_or(true, |found| found != text.as_bytes())
    };
    let stale = files.iter().filter(differs);
    let stale: Vec<String> = stale
        .map(|(name, _)| out.join(name).display().to_string())
        .collect();
    if stale.is_empty() {
        Ok(format!("{folder}: {what} is up to date"))
    } else {
        let stale = stale.join(", ");
        bail!("out of date: {stale}: run {command}")
    }
}

fn work(arguments: Arguments) -> Result<()> {
    let verbosity = Verbosity::of(arguments.quiet);
    say(match arguments.command {
        Command::Experiment(asked) => experiments(&asked, verbosity)?,
        Command::Report {
            out,
            quick,
            long,
            check,
        } => {
            let long_run = match (long, quick) {
                (true, _) => LongRun::Measured,
                (false, true) => LongRun::Quick,
                (false, false) => LongRun::Kept,
            };
            let what = "the accuracy report";
            let files = accuracy::report(&out, long_run, verbosity);
            let files = files.context(what)?;
            keep(&out, &files, check, what, "studies report")?
        }
        Command::Decisions {
            out,
            terrain,
            quick,
            check,
        } => {
            let extent = if quick {
                decisions::Extent::quick()
            } else {
                decisions::Extent::full()
            };
            let what = "the page of decisions";
            let folders = Folders {
                docs: &out,
                terrain: &terrain,
            };
            let files = decisions::page(folders, &extent, verbosity);
            let files = files.context(what)?;
            keep(&out, &files, check, what, "studies decisions")?
        }
        Command::Poses { out, quick, check } => {
            let extent = if quick {
                poses::Extent::quick()
            } else {
                poses::Extent::full()
            };
            let what = "the page of poses";
            let files = poses::page(&extent, verbosity).context(what)?;
            keep(&out, &files, check, what, "studies poses")?
        }
    });
    Ok(())
}

/// The fault as the exit status needs it: wrong arguments and files stay what they are.
fn fault(error: anyhow::Error) -> Error {
    let text = format!("{error:#}");
    match error.downcast() {
        Ok(input @ Error::Input(_)) => input,
        _ => Error::Work(text),
    }
}

fn main() -> ExitCode {
    program("studies", || work(Arguments::parse()).map_err(fault))
}
