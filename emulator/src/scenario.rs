//! What a board is put through, in one table: each scenario says what is disturbed, how long it
//! runs and what is expected. Most are cases, each with a board that one runner has; what
//! measures, or talks with the board, is a function.

mod broken;
mod runner;
mod supply;
mod trouble;

use std::path::{Path, PathBuf};

use clap::Args;
use host_sim::Error;
use host_sim::loaded::Loaded;
use host_sim::progress::Verbosity;

use crate::compare::{self, Circumstances, Probe};
use crate::deployment::flashed;
use crate::program::Program;
use crate::session::Session;
use crate::{deadlines, deploying, head, latency, serial, stopping, telemetry};
use runner::Case;

/// A scene and what is flashed for it; to a program that brings no scene with it this one is
/// deployed.
#[derive(Debug, Args)]
pub(crate) struct Flashed {
    /// The scene file
    pub(crate) scene: PathBuf,
    /// The program: built for it, or for any scene
    #[arg(long, value_name = "ELF")]
    pub(crate) program: PathBuf,
}

/// Scenes, and the programs that were built for them.
#[derive(Debug, Args)]
pub(crate) struct Several {
    /// The scene files
    #[arg(required = true)]
    pub(crate) scenes: Vec<PathBuf>,
    /// The programs, in the same order; none: on the PC, where that can be done
    #[arg(long, value_name = "ELF")]
    pub(crate) program: Vec<PathBuf>,
}

/// What a scenario is given.
#[derive(Debug, Args)]
pub(crate) struct Given {
    /// What is flashed
    #[command(flatten)]
    pub(crate) flashed: Flashed,
    /// The program of the same scene without telemetry, or without a serial port
    #[arg(long, value_name = "ELF")]
    without: Option<PathBuf>,
    /// The program of the same scene at a baud that cannot carry records
    #[arg(long, value_name = "ELF")]
    slow: Option<PathBuf>,
    /// The scene in whose world a board is that is deployed to
    #[arg(long, value_name = "SCENE")]
    world: Option<PathBuf>,
    /// The model that is deployed
    #[arg(long, value_name = "FILE")]
    model: Option<PathBuf>,
    /// Who fetches the log while PC and board are compared
    #[arg(long, value_enum, default_value_t)]
    probe: Probe,
    /// How many seconds of the scene PC and board are compared; none: all of it
    #[arg(long, value_name = "S")]
    duration: Option<f64>,
    /// By how many millionths the crystals of a head's boards are faster and, of every other one,
    /// slower
    #[arg(long, default_value_t = 0, value_parser = clap::value_parser!(i32).range(0..=1_000))]
    ppm: i32,
    /// Over how many minutes of simulated time deadlines are measured
    #[arg(long, default_value_t = 10.0)]
    minutes: f64,
    /// How often motors are stopped under each flood
    #[arg(long, default_value_t = 100)]
    stops: u32,
    /// Prints them as a table of comma-separated values
    #[arg(long)]
    csv: bool,
    /// No progress on standard error
    #[arg(skip = Verbosity::Normal)]
    pub(crate) verbosity: Verbosity,
}

enum What {
    /// Cases, each on a board of its own.
    Steps(fn(&Loaded, &Program) -> Result<Vec<Case>, Error>),
    /// More than that, by the files of scene and program; what was seen.
    Work(fn(&Given, &Path, &Path) -> Result<Vec<String>, Error>),
}

pub(crate) struct Scenario {
    pub(crate) name: &'static str,
    /// What it does, and when it fails.
    pub(crate) what: &'static str,
    how: What,
}

pub(crate) const ALL: [Scenario; 14] = [
    Scenario {
        name: "compare",
        what: "Runs the scene on PC and board and compares every tick",
        how: What::Work(|given, scene, program| {
            let circumstances = Circumstances {
                probe: given.probe,
                ..Circumstances::default()
            };
            let (mut loaded, program) = flashed(scene, program)?;
            loaded.scene.duration_s = given.duration.unwrap_or(loaded.scene.duration_s);
            let agreed = compare::compare(loaded, scene, &program, circumstances)?;
            let (scene, stack) = (scene.display(), agreed.stack);
            Ok(vec![format!("{scene}: {agreed}; {stack} bytes of stack")])
        }),
    },
    Scenario {
        name: "head",
        what: "Runs the scene on boards that a bus joins, and compares every tick with the \
               simulated head",
        how: What::Work(|given, scene, program| {
            head::compare(scene, program, given.duration, given.ppm)
        }),
    },
    Scenario {
        name: "relay",
        what: "Talks with the last board of a head by way of the first; fails if an answer is \
               wrong, a record not that of the simulated head, or what is sent to it does not run",
        how: What::Work(|_, scene, program| head::relay(scene, program)),
    },
    Scenario {
        name: "deadlines",
        what: "Measures how the board keeps its time; fails if it misses a tick",
        how: What::Work(|given, scene, program| {
            deadlines::measure(scene, program, given.minutes, given.csv, given.verbosity)
        }),
    },
    Scenario {
        name: "latency",
        what: "Measures how long contact on one side takes to excite the other; fails if it does \
               so in another tick than the one that reads it",
        how: What::Work(|_, scene, program| latency::measure(scene, program)),
    },
    Scenario {
        name: "overload",
        what: "Makes ticks too long; fails if deadline counter or watchdog do not act",
        how: What::Steps(|loaded, _| Ok(trouble::overload(&loaded.scene))),
    },
    Scenario {
        name: "starting",
        what: "Resets the chip in every way that was not asked for; fails if a motor is driven \
               after it before the user button is pressed",
        how: What::Steps(|_, _| Ok(trouble::starting())),
    },
    Scenario {
        name: "supply",
        what: "Lets the supply dip and the clock stop; fails if the motor pins are not low in \
               time, or the next start does not say why",
        how: What::Steps(|_, program| Ok(supply::dip(program.model()?.facts.code))),
    },
    Scenario {
        name: "sensor-loss",
        what: "Breaks the sensors' wires of a scene that whisks, side by side; fails if the motor \
               of a lost side is not switched off or stays off, or another rests",
        how: What::Steps(|loaded, _| Ok(broken::sensor_loss(&loaded.scene))),
    },
    Scenario {
        name: "damage",
        what: "Flips bits in the settings and in the model; fails if the motors are not switched \
               off, or the log does not say why",
        how: What::Steps(|loaded, program| broken::damage(&loaded.scene, program)),
    },
    Scenario {
        name: "deploying",
        what: "Deploys the scene with --model to a board whose scene names none, in --world; \
               after a right one PC and board must agree; fails if a wrong or interrupted one is \
               not refused, or does not leave the scene before",
        how: What::Work(|given, _, _| {
            let (world, model) = (named(given.world.as_ref())?, named(given.model.as_ref())?);
            deploying::deploying(&given.flashed, world, model)
        }),
    },
    Scenario {
        name: "telemetry",
        what: "Has a PC talk to the board; fails if an answer is wrong, a record not that of the \
               same module on the PC, or telemetry takes more instructions than it may beside the \
               program --without it",
        how: What::Work(|given, scene, program| {
            telemetry::talk(scene, program, named(given.without.as_ref())?)
        }),
    },
    Scenario {
        name: "stopping",
        what: "Stops the board's motors by every way while its links are flooded, --stops times a \
               flood; fails if a motor is driven later than in the tick after the stop has come, \
               or a stop is not answered",
        how: What::Work(|given, scene, program| stopping::stopping(scene, program, given.stops)),
    },
    Scenario {
        name: "serial",
        what: "Talks with the board over its serial line, also at a --slow baud; fails if a line, \
               a record or an answer is not what it should be, something is lost, or the tick \
               takes longer for it than --without",
        how: What::Work(|given, scene, program| {
            let [slow, without] = [&given.slow, &given.without].map(Option::as_ref);
            serial::talk(scene, [program, named(slow)?, named(without)?])
        }),
    },
];

fn named(path: Option<&PathBuf>) -> Result<&Path, Error> {
    let missing = || Error::Input("a file of this scenario is not named; see --help".to_owned());
    path.map(PathBuf::as_path).ok_or_else(missing)
}

impl Scenario {
    /// Puts a board through it; what was seen, a line each.
    pub(crate) fn run(&self, given: &Given) -> Result<Vec<String>, Error> {
        let Flashed { scene, program } = &given.flashed;
        let cases = match self.how {
            What::Work(work) => return work(given, scene, program),
            What::Steps(cases) => cases,
        };
        let (loaded, program) = flashed(scene, program)?;
        let mut said = Vec::new();
        for case in cases(&loaded, &program)? {
            let board = Session::running(&loaded.scene, Vec::new(), &program)?;
            said.extend(runner::run(board, &case)?);
        }
        Ok(said)
    }
}
