//! The command line. `host-sim --help` documents it.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand, ValueEnum};
use host_sim::Error;
use host_sim::accuracy::LongRun;
use host_sim::commands::experiment::Asked;
use host_sim::commands::{
    classify, experiment, main_job, merge, record, report as accuracy, run, train,
};
use host_sim::experiment::{Name, Shard};
use host_sim::progress::Verbosity;
use host_sim::report;
use scene::Rule;

/// Simulates active whisker modules: the firmware's tick on a mock SPI bus and
/// mock motors, with whiskers and surfaces behind them.
///
/// Without a command it runs the main job: the left whisker of a module learns
/// four textures by whisking against them, then decides by touch which one it
/// feels; decisions are printed as they fall, and traces, model and a plot are
/// written to out/textures.
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
    /// Runs one scene: writes DIR/trace.csv, and DIR/decisions.csv where the scene classifies
    Run {
        /// The scene file (docs/scenes.md lists its keys)
        scene: PathBuf,
        /// Where to write
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
    },
    /// Runs one scene and records what its first whisker feels, to learn from
    Record {
        /// The scene file
        scene: PathBuf,
        /// Where to write the recording
        #[arg(long, value_name = "FILE.csv")]
        out: PathBuf,
        /// Another seed than the scene's
        #[arg(long)]
        seed: Option<u64>,
    },
    /// Learns a likelihood model from a recording
    #[command(allow_negative_numbers = true)]
    Train {
        /// The recording: label,trial,x,y
        #[arg(long, value_name = "FILE.csv")]
        data: PathBuf,
        /// Where to write the model
        #[arg(long, value_name = "MODEL")]
        out: PathBuf,
        /// Bins over each channel's range
        #[arg(long, default_value_t = 100)]
        bins: usize,
        /// Standard deviation of the smoothing, in bins; 0: none
        #[arg(long, default_value_t = 5.0)]
        smooth: f64,
        /// Samples whose mean log-likelihood is one step of evidence
        #[arg(long, default_value_t = 20)]
        block: u32,
    },
    /// Streams a recording through the fixed-point classifier, exactly the code
    /// that runs on the board
    #[command(allow_negative_numbers = true)]
    Classify {
        /// The model
        #[arg(long)]
        model: PathBuf,
        /// The recording: label,trial,x,y
        #[arg(long, value_name = "FILE.csv")]
        data: PathBuf,
        /// When to decide
        #[arg(long, value_enum)]
        rule: RuleName,
        /// Sequential: decide when a posterior probability exceeds this
        #[arg(long, value_name = "P", required_if_eq("rule", "sequential"))]
        threshold: Option<f64>,
        /// Window: decide after this many samples, a multiple of the model's block
        #[arg(long, value_name = "N", required_if_eq("rule", "window"))]
        window: Option<u32>,
        /// Where to write the decisions
        #[arg(long, value_name = "FILE.csv")]
        out: PathBuf,
    },
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
        #[arg(long, value_name = "DIR", default_value = "docs")]
        out: PathBuf,
        /// Run ten minutes in place of showing the kept 24 hours
        #[arg(long)]
        quick: bool,
        /// Run the 24 hours anew and keep them (DIR/accuracy/long-run.csv)
        #[arg(long, conflicts_with = "quick")]
        long: bool,
        /// Only say whether the report is up to date; timings of the PC are left out
        #[arg(long, conflicts_with_all = ["quick", "long"])]
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
    /// Joins the parts of all shards and evaluates them
    Merge {
        /// The parts, in any order
        #[arg(required = true, value_name = "PART")]
        parts: Vec<PathBuf>,
        /// The folder of the rigs that the parts were made on; those built in if none
        #[arg(long, value_name = "DIR")]
        rigs: Option<PathBuf>,
        /// Where to write
        #[arg(long, value_name = "DIR", default_value = "out/experiments")]
        out: PathBuf,
    },
}

/// How an experiment is run.
#[derive(clap::Args)]
struct Options {
    /// Fewer trials, whisks, contacts, sweeps and runs; the same physics
    #[arg(long)]
    quick: bool,
    /// All chance comes from it
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Record only share i of n, into a part file
    #[arg(long, value_name = "i/n")]
    shard: Option<Shard>,
    /// The folder of the rigs' files (rigs/*.toml); those built in if none
    #[arg(long, value_name = "DIR")]
    rigs: Option<PathBuf>,
    /// Where to write
    #[arg(long, value_name = "DIR", default_value = "out/experiments")]
    out: PathBuf,
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
            Self::Merge { parts, rigs, out } => {
                return merge::merge(&parts, rigs.as_deref(), &out);
            }
        };
        let asked = Asked {
            names,
            quick: options.quick,
            seed: options.seed,
            shard: options.shard,
            rigs: options.rigs,
            out: options.out,
        };
        experiment::experiment(&asked, verbosity)
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
    let verbosity = if arguments.quiet {
        Verbosity::Quiet
    } else {
        Verbosity::Normal
    };
    let summary = match arguments.command {
        None => return main_job::main_job(verbosity),
        Some(Command::Run { scene, out }) => run::run(&scene, &out, verbosity)?,
        Some(Command::Record { scene, out, seed }) => {
            Some(record::record(&scene, &out, seed, verbosity)?)
        }
        Some(Command::Train {
            data,
            out,
            bins,
            smooth,
            block,
        }) => Some(train::train(&data, &out, bins, smooth, block)?),
        Some(Command::Classify {
            model,
            data,
            rule: name,
            threshold,
            window,
            out,
        }) => {
            let rule = rule(name, threshold, window)?;
            Some(classify::classify(&model, &data, rule, &out, verbosity)?)
        }
        Some(Command::Experiment { which }) => Some(which.work(verbosity)?),
        Some(Command::Report {
            out,
            quick,
            long,
            check,
        }) => {
            let long_run = match (long, quick) {
                (true, _) => LongRun::Anew,
                (false, true) => LongRun::Quick,
                (false, false) => LongRun::Kept,
            };
            Some(accuracy::report(&out, long_run, check, verbosity)?)
        }
    };
    if let Some(summary) = summary {
        report::say(summary);
    }
    Ok(())
}

fn main() -> ExitCode {
    match work(Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            report::warn(format_args!("host-sim: {error}"));
            ExitCode::from(error.exit_status())
        }
    }
}
