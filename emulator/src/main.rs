//! The emulated board's command line; `cargo xtask emulate` builds the program
//! and calls it.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand};
use emulator::campaign::{self, Ending, Plan, Shard, ShardTable};
use emulator::scenario::{self, Flashed, Given, Scenario};
use emulator::{emulate, endurance, picture, registers};
use host_sim::output::{self, write_whole};
use host_sim::progress::Verbosity;
use host_sim::{Error, report};

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
    /// Draws what both sides do in scenes with obstacles, one below the other
    Picture {
        #[command(flatten)]
        several: Several,
        /// The SVG file to write
        #[arg(long, value_name = "FILE")]
        out: PathBuf,
    },
    /// Injects faults at random into running scenes and writes a row a run
    Campaign(Campaign),
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
    Endure(Endure),
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

/// A scenario by its name.
fn scenarios() -> impl TypedValueParser<Value = &'static Scenario> {
    let name = |scenario: &Scenario| PossibleValue::new(scenario.name).help(scenario.what);
    PossibleValuesParser::new(scenario::ALL.iter().map(name)).try_map(|name| {
        let mut all = scenario::ALL.iter();
        all.find(|scenario| scenario.name == name)
            .ok_or("no such scenario")
    })
}

/// Scenes, and the programs that were built for them.
#[derive(Args)]
struct Several {
    /// The scene files
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// The programs, in the same order; none: on the PC, where that can be done
    #[arg(long, value_name = "ELF")]
    program: Vec<PathBuf>,
}

/// Which runs are made, and where their rows are kept.
#[derive(Args)]
struct Campaign {
    #[command(flatten)]
    several: Several,
    /// A run for every word of RAM of the only scene's program, of which it flips a bit
    #[arg(long, requires = "program")]
    words: bool,
    /// What the rows call it
    #[arg(long, default_value = "host-sim")]
    subject: String,
    /// The number of the first run
    #[arg(long, default_value_t = 0)]
    first: u64,
    /// How many runs; with --words no more than there are words
    #[arg(long, default_value_t = u64::MAX, required_unless_present = "words")]
    runs: u64,
    /// Which shard
    #[arg(long, default_value_t = 0)]
    shard: u64,
    /// Of how many
    #[arg(long, default_value_t = 1)]
    shards: u64,
    /// The table of the shard: rows that it has are not run again
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

/// A long run.
#[derive(Args)]
struct Endure {
    /// The scene file
    scene: PathBuf,
    /// The program that was built for it; none: on the PC
    #[arg(long, value_name = "ELF", requires = "subject")]
    program: Option<PathBuf>,
    /// What the row calls the board
    #[arg(long)]
    subject: Option<String>,
    /// The seed in place of the scene's own, on the PC
    #[arg(long, default_value_t = 1, conflicts_with = "program")]
    seed: u64,
    /// For how many simulated hours
    #[arg(long)]
    hours: f64,
    /// The file of the shard
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

/// Makes the long run of a shard.
fn endure(run: &Endure) -> Result<(), Error> {
    output::check(&run.out)?;
    let row = match (&run.program, &run.subject) {
        (Some(program), Some(subject)) => {
            endurance::on_board(&run.scene, program, subject, run.hours)?
        }
        _ => endurance::on_pc(&run.scene, run.seed, run.hours)?,
    };
    row.write(&run.out)
}

/// Makes the runs of a shard that its table does not have yet.
fn inject(campaign: Campaign) -> Result<(), Error> {
    let Several { scenes, program } = campaign.several;
    let programs = program.into_iter().map(Some);
    let programs = programs.chain(std::iter::repeat(None));
    let scenes = scenes.into_iter().zip(programs).collect();
    let shard = Shard {
        first: campaign.first,
        end: campaign.first.saturating_add(campaign.runs),
        remainder: campaign.shard,
        shards: campaign.shards.max(1),
    };
    let plan = if campaign.words {
        Plan::Words
    } else {
        Plan::Drawn
    };
    let mut table = ShardTable::open(&campaign.out)?;
    let done = table.done().to_vec();
    campaign::run(&campaign.subject, &scenes, plan, shard, &done, |row| {
        table.add(&row)
    })
}

/// The page of the campaign.
fn reliability(tables: &[PathBuf], out: Option<&Path>) -> Result<(), Error> {
    let tables: Result<Vec<_>, Error> = tables.iter().map(|path| campaign::rows(path)).collect();
    let rows = campaign::merge(tables?)?;
    if let Some(out) = out {
        let page = campaign::page(&rows).map_err(Error::Work)?;
        write_whole(out, page.as_bytes())?;
    }
    let harmful = rows.iter().filter(|row| row.outcome == Ending::Harmful);
    let harmful: Vec<String> = harmful.map(campaign::described).collect();
    if harmful.is_empty() {
        report::say(format_args!("{} runs, none harmful", rows.len()));
        Ok(())
    } else {
        Err(Error::Work(harmful.join("\n")))
    }
}

fn draw(Several { scenes, program }: &Several, out: &Path) -> Result<(), Error> {
    output::check(out)?;
    if scenes.len() != program.len() {
        return Err(Error::Input("each scene needs its program".to_owned()));
    }
    let flashed = scenes.iter().zip(program);
    let flashed: Vec<_> = flashed.map(|(scene, elf)| (&**scene, &**elf)).collect();
    write_whole(out, picture::picture(&flashed)?.as_bytes())?;
    Ok(())
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
        Command::Picture { several, out } => draw(&several, &out)?,
        Command::Campaign(campaign) => inject(campaign)?,
        Command::Endure(run) => endure(&run)?,
        Command::Endurance { shards, out } => {
            let rows: Result<Vec<_>, _> =
                shards.iter().map(|shard| endurance::row(shard)).collect();
            write_whole(&out, endurance::page(&rows?).as_bytes())?;
        }
        Command::Reliability { tables, out } => reliability(&tables, out.as_deref())?,
        Command::Facts { board: None } => report::say(registers::page().trim_end()),
        Command::Facts { board: Some(board) } => report::say(registers::table(&board)?.trim_end()),
    }
    Ok(())
}

fn main() -> ExitCode {
    report::program("emulator", || work(Arguments::parse()))
}
