//! The emulated board's command line; `cargo xtask emulate` builds the program
//! and calls it.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand, ValueEnum};
use emulator::campaign::{self, Ending, Plan, Shard, ShardTable};
use emulator::compare::{Circumstances, Probe};
use emulator::endurance;
use emulator::{
    compare, counts, damage, deadlines, deploying, emulate, latency, overload, picture, registers,
    sensor_loss, serial, starting, supply, telemetry,
};
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
    /// Draws what both sides do in scenes with obstacles, one below the other
    Picture {
        /// The scene files
        #[arg(required = true)]
        scenes: Vec<PathBuf>,
        /// The programs that were built for them, in the same order
        #[arg(long, value_name = "ELF", required = true)]
        program: Vec<PathBuf>,
        /// The SVG file to write
        #[arg(long, value_name = "FILE")]
        out: PathBuf,
    },
    /// Runs one scene on PC and board and compares every tick
    Compare {
        #[command(flatten)]
        flashed: Flashed,
        /// Who fetches the log
        #[arg(long, value_enum, default_value_t = Reader::Attached)]
        probe: Reader,
    },
    /// Measures how the board keeps its time; fails if it misses a tick
    Deadlines {
        #[command(flatten)]
        flashed: Flashed,
        /// Over how many minutes of simulated time
        #[arg(long, default_value_t = 10.0)]
        minutes: f64,
        /// Print them as a table of comma-separated values
        #[arg(long)]
        csv: bool,
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
    /// Breaks the sensors' wires of a scene that whisks, side by side; fails if the motor of
    /// a lost side is not switched off or stays off, or another rests
    SensorLoss(Flashed),
    /// Measures how long contact on one side takes to excite the other; fails if it does so
    /// in another tick than the one that reads it
    Latency(Flashed),
    /// Resets the chip in every way that was not asked for; fails if a motor is driven after it
    /// before the user button is pressed
    Starting(Flashed),
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
    /// Flips bits in the settings and in the model of a scene; fails if the motors are not
    /// switched off, or the log does not say why
    Damage(Flashed),
    /// Deploys a scene with a model to a board whose scene names none: after a right one PC and
    /// board must agree; fails if a wrong or interrupted one is not refused, or does not leave
    /// the scene before
    Deploying {
        #[command(flatten)]
        flashed: Flashed,
        /// The scene in whose world it is
        #[arg(long, value_name = "SCENE")]
        world: PathBuf,
        /// The right model
        #[arg(long, value_name = "FILE")]
        model: PathBuf,
    },
    /// Lets the supply dip and the clock stop; fails if the motor pins are not low in time, or
    /// the next start does not say why
    Supply(Flashed),
    /// Has a PC talk to the board; fails if an answer is wrong, a record not that of the same
    /// module on the PC, or telemetry takes more instructions than it may
    Telemetry {
        #[command(flatten)]
        flashed: Flashed,
        /// The program of the same scene without telemetry
        #[arg(long, value_name = "ELF")]
        without: PathBuf,
    },
    /// Talks with the board over its serial line; fails if a line, a record or an answer is
    /// not what it should be, something is lost, or the tick takes longer for it
    Serial {
        #[command(flatten)]
        flashed: Flashed,
        /// The program of the same scene at a baud that cannot carry records
        #[arg(long, value_name = "ELF")]
        slow: PathBuf,
        /// The program of the same scene without a serial port
        #[arg(long, value_name = "ELF")]
        without: PathBuf,
    },
    /// Makes ticks too long on purpose; fails if deadline counter or watchdog do not act
    Overload(Flashed),
}

/// Which runs are made, and where their rows are kept.
#[derive(Args)]
struct Campaign {
    /// The scene files
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// The programs that were built for them, in the same order; none: on the PC
    #[arg(long, value_name = "ELF")]
    program: Vec<PathBuf>,
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

/// Who fetches the log from the board.
#[derive(Clone, Copy, ValueEnum)]
enum Reader {
    /// A probe
    Attached,
    /// Nobody
    Absent,
    /// A probe that is pulled while the program waits for it
    Pulled,
}

impl From<Reader> for Probe {
    fn from(reader: Reader) -> Self {
        match reader {
            Reader::Attached => Self::Attached,
            Reader::Absent => Self::Absent,
            Reader::Pulled => Self::Pulled,
        }
    }
}

/// A scene and what is flashed for it; to a program that brings no scene with it this one is
/// deployed.
#[derive(Args)]
struct Flashed {
    /// The scene file
    scene: PathBuf,
    /// The program: built for it, or for any scene
    #[arg(long, value_name = "ELF")]
    program: PathBuf,
}

/// Makes the runs of a shard that its table does not have yet.
fn inject(campaign: Campaign) -> Result<(), Error> {
    let programs = campaign.program.into_iter().map(Some);
    let programs = programs.chain(std::iter::repeat(None));
    let scenes = campaign.scenes.into_iter().zip(programs).collect();
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

/// Deploys scenes, and tells what was seen.
fn deploy(flashed: &Flashed, world: &Path, model: &Path) -> Result<(), Error> {
    let bench = deploying::Boards {
        scene: &flashed.scene,
        world,
        program: &flashed.program,
    };
    let lines = deploying::deploying(bench, model)?;
    lines.iter().for_each(report::say);
    Ok(())
}

fn draw(scenes: &[PathBuf], programs: &[PathBuf], out: &Path) -> Result<(), Error> {
    output::check(out)?;
    let flashed = scenes.iter().zip(programs);
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
        Command::Picture {
            scenes,
            program,
            out,
        } => draw(&scenes, &program, &out)?,
        Command::Compare {
            flashed: Flashed { scene, program },
            probe,
        } => {
            let agreed = compare::compare(
                &scene,
                &program,
                Circumstances {
                    probe: probe.into(),
                    ..Circumstances::default()
                },
            )?;
            report::say(format_args!(
                "{}: PC and board agree to the last bit in {} ticks, {} decisions; {} bytes of stack",
                scene.display(),
                agreed.ticks,
                agreed.decisions,
                agreed.stack
            ));
        }
        Command::Deadlines {
            flashed: Flashed { scene, program },
            minutes,
            csv,
        } => {
            let measured = deadlines::measure(&scene, &program, minutes, verbosity)?;
            if csv {
                report::say(measured.csv());
            } else {
                report::say(&measured);
            }
            if measured.missed > 0 {
                return Err(Error::Work(format!("{} ticks missed", measured.missed)));
            }
        }
        Command::Count { program, board } => report::say(counts::count(&program, &board)?),
        Command::Deploying {
            flashed,
            world,
            model,
        } => deploy(&flashed, &world, &model)?,
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
        Command::Damage(Flashed { scene, program }) => {
            report::say(damage::damage(&scene, &program)?.join("\n"));
        }
        Command::Overload(Flashed { scene, program }) => {
            report::say(overload::overload(&scene, &program)?.join("\n"));
        }
        Command::Starting(Flashed { scene, program }) => {
            report::say(starting::start_again(&scene, &program)?.join("\n"));
        }
        Command::Telemetry {
            flashed: Flashed { scene, program },
            without,
        } => report::say(telemetry::talk(&scene, &program, &without)?.join("\n")),
        Command::Serial {
            flashed: Flashed { scene, program },
            slow,
            without,
        } => report::say(serial::talk(&scene, [&program, &slow, &without])?.join("\n")),
        Command::Supply(Flashed { scene, program }) => {
            report::say(supply::dip(&scene, &program)?.join("\n"));
        }
        Command::Latency(Flashed { scene, program }) => {
            let measured = latency::measure(&scene, &program)?;
            for latency in measured {
                report::say(latency);
            }
            if measured.iter().any(|one| one.ticks != latency::EXPECTED) {
                return Err(Error::Work("excitation comes in another tick".to_owned()));
            }
        }
        Command::SensorLoss(Flashed { scene, program }) => {
            report::say(sensor_loss::lose(&scene, &program)?.join("\n"));
        }
    }
    Ok(())
}

fn main() -> ExitCode {
    report::program("emulator", || work(Arguments::parse()))
}
