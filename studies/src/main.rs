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
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use clap::{Args, Parser, Subcommand};
use host_sim::Error;
use host_sim::output::write_whole;
use host_sim::progress::Verbosity;
use host_sim::report::{program, say};

use cores::Cores;
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
    Report(Made),
    /// Measures what decisions are worth and writes DIR/decisions.md with its table and pictures
    Decisions {
        #[command(flatten)]
        made: Made,
        /// Where the recordings of terrain are
        #[arg(long, value_name = "DIR", default_value = "tests/data/terrain")]
        terrain: PathBuf,
    },
    /// Measures what decisions are worth where use differs from training and writes
    /// DIR/poses.md with its table
    Poses(Made),
    /// Measures by how much estimates of tilt and depth are wrong and writes DIR/standing.md with
    /// its table and picture
    Standing(Made),
}

/// How a page is made.
#[derive(Args)]
struct Made {
    /// Where documents are: instructions.csv is read, the page written there
    #[arg(long, value_name = "DIR", default_value = "docs/measured")]
    out: PathBuf,
    /// Fewer runs, trainings and settings; the accuracy report is short as it is
    #[arg(long)]
    quick: bool,
    /// Only say whether the page is up to date
    #[arg(long, conflicts_with = "quick")]
    check: bool,
}

/// With `--check` says whether the files there are the same. Returns what was done.
fn keep(made: &Made, files: Result<Files>, what: &str, command: &str) -> Result<String> {
    let files = files.with_context(|| what.to_owned())?;
    let folder = made.out.display();
    if !made.check {
        for (name, text) in &files {
            write_whole(&made.out.join(name), text.as_bytes())?;
        }
        return Ok(format!("{folder}: {} files of {what}", files.len()));
    }
    let is_stale =
        |path: &Path, text: &str| !std::fs::read(path).is_ok_and(|found| found == text.as_bytes());
    let files = files.iter().map(|(name, text)| (made.out.join(name), text));
    let stale = files.filter(|(path, text)| is_stale(path, text));
    let stale: Vec<String> = stale.map(|(path, _)| path.display().to_string()).collect();
    if !stale.is_empty() {
        bail!("out of date: {}: run studies {command}", stale.join(", "));
    }
    Ok(format!("{folder}: {what} is up to date"))
}

fn work(arguments: Arguments) -> Result<()> {
    let verbosity = Verbosity::of(arguments.quiet);
    say(match arguments.command {
        Command::Experiment(asked) => experiment::run(&asked, verbosity)?.display().to_string(),
        Command::Report(made) => {
            let files = accuracy::report(&made.out);
            keep(&made, files, "the accuracy report", "report")?
        }
        Command::Decisions { made, terrain } => {
            let extent = decisions::Extent::new(made.quick, Cores(verbosity));
            let files = decisions::page(&made.out, &terrain, &extent);
            keep(&made, files, "the page of decisions", "decisions")?
        }
        Command::Poses(made) => {
            let files = poses::page(&poses::Extent::new(made.quick, Cores(verbosity)));
            keep(&made, files, "the page of poses", "poses")?
        }
        Command::Standing(made) => {
            let files = poses::standing::page(&poses::Extent::new(made.quick, Cores(verbosity)));
            keep(&made, files, "the page of estimated poses", "standing")?
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
