//! The program: its commands and their options, and what it prints of them.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand, ValueEnum};
use scene::Rule;

use super::choice::{SceneChoice, seed};
use super::{
    channels, classify, columns, evaluate, main_job, press, record, run, score, sweep, train,
};
use crate::output::is_stdout;
use crate::progress::Verbosity;
use crate::{Error, report};

/// Simulates active whisker modules: the firmware's tick on a mock SPI bus and
/// mock motors, with whiskers and surfaces behind them.
///
/// Without a command it runs the main job: the left whisker of a module is trained on four textures
/// by whisking against them, then decides by touch which one it feels; decisions are printed as
/// they are made, and traces, model and a plot are written to out/bench-textures.
///
/// Exit status: 0 done, 1 the work failed, 2 the arguments or a file are wrong.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    /// No progress on standard error
    #[arg(long, global = true)]
    quiet: bool,

    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand)]
enum Command {
    /// Runs one scene: writes DIR/trace.csv, DIR/decisions.csv where the scene classifies, and
    /// a picture of them
    #[command(allow_negative_numbers = true)]
    Run(run::Arguments),
    /// Runs one scene and records, to train on, what its first whisker feels, or each that decides
    #[command(allow_negative_numbers = true)]
    Record {
        #[command(flatten)]
        scene: SceneChoice,
        /// Where to write the recording; - is standard output
        #[arg(long, value_name = "FILE.csv")]
        out: PathBuf,
        /// Another seed than the scene's
        #[arg(long, value_name = "N", value_parser = seed)]
        seed: Option<u64>,
    },
    /// Trains a likelihood model from a recording, and says what it is worth
    #[command(allow_negative_numbers = true)]
    Train(train::Arguments),
    /// Says what a model is worth on a recording: hit rate, decision time, calibration,
    /// confusion, refused; suggests a threshold
    #[command(allow_negative_numbers = true)]
    Evaluate(evaluate::Arguments),
    /// Trains on one run of a scene and scores others, on all cores: mean, standard error, worst
    #[command(allow_negative_numbers = true)]
    Score(score::Arguments),
    /// Runs a scene with every combination of other values of some keys, on all cores: a
    /// table with decisions, decision time, touches, faults and errors of each run
    #[command(allow_negative_numbers = true)]
    Sweep(sweep::Arguments),
    /// Presses a tapered whisker slowly against a plate, solved exactly: base moment, forces and
    /// place of contact at each push of the motor
    #[command(allow_negative_numbers = true)]
    Press(press::Arguments),
    /// Prints what the columns of all these files mean: docs/files.md
    Columns,
    /// Streams a recording through the fixed-point classifier, exactly the code
    /// that runs on the board
    #[command(allow_negative_numbers = true)]
    Classify {
        /// The model
        #[arg(long)]
        model: PathBuf,
        /// The recording: label,trial,x,y, and contact where samples are of the air too
        #[arg(long, value_name = "FILE.csv")]
        data: PathBuf,
        /// Two other columns in place of x,y
        #[arg(long, value_name = "A,B", default_value = "x,y", value_parser = channels)]
        channels: [String; 2],
        /// When to decide
        #[arg(long, value_enum)]
        rule: RuleName,
        /// Sequential: decide when a posterior probability exceeds this
        #[arg(
            long,
            value_name = "P",
            required_if_eq("rule", "sequential"),
            conflicts_with = "window"
        )]
        threshold: Option<f64>,
        /// Window: decide after this many samples, a multiple of the model's block
        #[arg(long, value_name = "N", required_if_eq("rule", "window"))]
        window: Option<u32>,
        /// Where to write the decisions; - is standard output
        #[arg(long, value_name = "FILE.csv")]
        out: PathBuf,
    },
}

impl Command {
    fn is_piped(&self) -> bool {
        match self {
            Self::Record { out, .. } | Self::Classify { out, .. } => is_stdout(out),
            Self::Sweep(arguments) => is_stdout(&arguments.out),
            _ => false,
        }
    }
}

#[derive(Clone, Copy, ValueEnum)]
enum RuleName {
    /// When a posterior exceeds the threshold
    Sequential,
    /// By maximum likelihood over fixed windows
    Window,
}

fn rule(name: RuleName, threshold: Option<f64>, window: Option<u32>) -> Result<Rule, Error> {
    let missing = |what: &str| Error::Input(format!("--{what} is missing"));
    Ok(match name {
        RuleName::Sequential => Rule::Sequential {
            threshold: threshold.ok_or_else(|| missing("threshold"))?,
        },
        RuleName::Window => Rule::Window {
            samples: window.ok_or_else(|| missing("window"))?,
        },
    })
}

fn work(arguments: Arguments) -> Result<(), Error> {
    let verbosity = Verbosity::of(arguments.quiet);
    // Where a table goes to standard output, nothing else does.
    let piped = arguments.command.as_ref().is_some_and(Command::is_piped);
    let summary = match arguments.command {
        None => return main_job::main_job(verbosity),
        Some(Command::Run(arguments)) => Some(run::run(&arguments, verbosity)?),
        Some(Command::Columns) => Some(columns::page().trim_end().to_owned()),
        Some(Command::Record { scene, out, seed }) => {
            Some(record::record(&scene, &out, seed, verbosity)?)
        }
        Some(Command::Train(arguments)) => Some(train::train(&arguments)?),
        Some(Command::Evaluate(arguments)) => Some(evaluate::evaluate(&arguments, verbosity)?),
        Some(Command::Sweep(arguments)) => Some(sweep::sweep(&arguments, verbosity)?),
        Some(Command::Press(arguments)) => press::press(&arguments)?,
        Some(Command::Score(arguments)) => Some(score::score(&arguments, verbosity)?),
        Some(Command::Classify {
            model,
            data,
            channels: [a, b],
            rule: name,
            threshold,
            window,
            out,
        }) => {
            let rule = rule(name, threshold, window)?;
            let channels = [a.as_str(), &b];
            let done = classify::classify(&model, &data, channels, rule, &out, verbosity);
            Some(done?)
        }
    };
    match summary {
        Some(summary) if piped => report::warn(summary),
        Some(summary) => report::say(summary),
        None => {}
    }
    Ok(())
}

/// Does what its arguments say, and says what came of it.
pub fn main() -> ExitCode {
    report::program("host-sim", || work(report::arguments()))
}
