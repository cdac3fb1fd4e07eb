//! A scene on an emulated board: builds the board's program and runs it there.

pub(crate) mod variants;

use std::path::{Path, PathBuf};

use clap::ValueEnum;

use crate::firmware::{self, Board};
use crate::run::{Fault, absolute, listing, output, run, target, top, workspace_program};

/// Who fetches the log from a board.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Probe {
    /// A probe
    Attached,
    /// Nobody
    Absent,
    /// A probe that is pulled while the program waits for it
    Pulled,
}

/// What is done with a scene.
#[derive(Debug, Clone)]
pub(crate) enum Task {
    /// Writes its files there.
    Run(PathBuf),
    /// Compares every tick with host-sim, with such a probe at the board's log.
    Compare(Probe),
    /// Measures how the board keeps its time, over so many minutes.
    Deadlines(f64),
    /// Makes ticks too long on purpose.
    Overload,
    /// Resets the chip in every way that nobody asked for.
    Starting,
    /// Lets the supply dip and the clock stop.
    Supply,
    /// Has a PC talk to it.
    Telemetry,
    /// Talks with it over its serial line.
    Serial,
    /// Flips bits in what nothing writes.
    Damage,
    /// Breaks the sensors' wires on purpose.
    SensorLoss,
    /// Measures how long contact on one side takes to excite the other.
    Latency,
    /// Deploys scenes and models to it, right ones and wrong.
    Deploying,
}

/// A board, and how it gets its scenes.
#[derive(Debug)]
pub(crate) struct Emulated {
    board: Board,
    /// The program that takes any scene, to which they are deployed; `None`: each is linked into
    /// a program of the parts that it needs.
    any_scene: Option<PathBuf>,
}

impl Emulated {
    /// A board whose scenes are linked.
    pub(crate) const fn linked(board: Board) -> Self {
        Self {
            board,
            any_scene: None,
        }
    }

    /// Builds the program to which any scene is deployed.
    pub(crate) fn deployed(board: Board) -> Result<Self, Fault> {
        let any_scene = firmware::kept(|| firmware::build_any_scene(board))?;
        Ok(Self {
            board,
            any_scene: Some(any_scene),
        })
    }

    /// The program for a scene.
    fn program(&self, scene: &Path) -> Result<PathBuf, Fault> {
        match &self.any_scene {
            Some(program) => Ok(program.clone()),
            None => firmware::build_kept(self.board, scene),
        }
    }
}

/// Does `tasks` with `scene`, one after the other.
pub(crate) fn emulate(on: &Emulated, scene: &Path, tasks: &[Task]) -> Result<(), Fault> {
    let program = on.program(scene)?;
    let mut done = tasks.iter().map(|task| match task {
        Task::Serial => serial(on, scene, &program),
        _ => one(on, scene, (&program, task)),
    });
    done.try_for_each(|done| done)
}

/// Does a task with a scene and its program.
fn one(on: &Emulated, scene: &Path, (program, task): (&Path, &Task)) -> Result<(), Fault> {
    let mut command = workspace_program("emulator");
    let task_name = match task {
        Task::Run(_) => "run",
        Task::Compare(_) => "compare",
        Task::Deadlines(_) => "deadlines",
        Task::Overload => "overload",
        Task::Starting => "starting",
        Task::Supply => "supply",
        Task::Telemetry => "telemetry",
        Task::Serial => "serial",
        Task::Damage => "damage",
        Task::SensorLoss => "sensor-loss",
        Task::Latency => "latency",
        Task::Deploying => "deploying",
    };
    command.arg(task_name).arg(absolute(scene)?);
    match task {
        Task::Run(out) => command.arg("--out").arg(absolute(out)?),
        Task::Compare(Probe::Absent) => command.args(["--probe", "absent"]),
        Task::Compare(Probe::Pulled) => command.args(["--probe", "pulled"]),
        Task::Deadlines(minutes) => command.arg("--minutes").arg(minutes.to_string()),
        Task::Telemetry => {
            let without = variants::without_telemetry(scene, &target().join("telemetry"))?;
            command.arg("--without").arg(on.program(&without)?)
        }
        Task::Deploying => {
            let (world, model) = (top().join(WORLD), top().join(MODEL));
            command.arg("--world").arg(world).arg("--model").arg(model)
        }
        Task::Compare(Probe::Attached)
        | Task::Overload
        | Task::Starting
        | Task::Supply
        | Task::Serial
        | Task::Damage
        | Task::SensorLoss
        | Task::Latency => &mut command,
    };
    run(command.arg("--program").arg(program))
}

/// Bits a second that carry the records of one whisker at 2 kHz, and of two; and the
/// ST-LINK's default, that carries neither.
const SERIAL_BAUDS: [u32; 3] = [921_600, 2_000_000, 115_200];

/// Talks with a board over its serial line at two of [`SERIAL_BAUDS`]; `without` is the program
/// of the scene itself.
fn serial(on: &Emulated, scene: &Path, without: &Path) -> Result<(), Fault> {
    let folder = target().join("serial");
    let whiskers = variants::whiskers(scene)?;
    let [one, two, slow] = SERIAL_BAUDS;
    let bauds = [if whiskers > 1 { two } else { one }, slow];
    let mut command = workspace_program("emulator");
    command.arg("serial");
    let [fast, slow] = bauds.map(|baud| {
        let folder = folder.join(baud.to_string());
        variants::with_serial(scene, baud, &folder)
    });
    let fast = fast?;
    command.arg(absolute(&fast)?);
    command.arg("--program").arg(on.program(&fast)?);
    command.arg("--slow").arg(on.program(&slow?)?);
    run(command.arg("--without").arg(without))
}

/// Draws what both sides do in `scenes`, on the board, to the SVG file `out`.
pub(crate) fn picture(board: Board, scenes: &[PathBuf], out: &Path) -> Result<(), Fault> {
    let mut command = workspace_program("emulator");
    command.arg("picture");
    for scene in scenes {
        let program = firmware::build_kept(board, scene)?;
        command.arg(absolute(scene)?).arg("--program").arg(program);
    }
    run(command.arg("--out").arg(absolute(out)?))
}

/// What [`Task::Deadlines`] measures, as `what,mean,worst` lines.
pub(crate) fn deadlines(board: Board, scene: &Path, minutes: f64) -> Result<String, Fault> {
    let program = firmware::build(board, scene)?;
    let mut command = workspace_program("emulator");
    command.arg("--quiet");
    command.args(["deadlines", "--csv", "--minutes", &minutes.to_string()]);
    output(command.arg(top().join(scene)).arg("--program").arg(program))
}

/// Compares every scene in `scenes` that the board takes with host-sim; one with several
/// whiskers a side by the first of each. [`IN_FIXED_POINT`] are compared in fixed point
/// too, where a board has a choice and scenes are linked.
pub(crate) fn compare_all(on: &Emulated) -> Result<(), Fault> {
    let board = on.board;
    for scene in listing(&top().join("scenes"), "toml")? {
        let taken = variants::single(&scene, &target().join("single"))?.unwrap_or(scene);
        if let Err(reason) = firmware::linked(board, &taken)? {
            println!("not on the {}: {}: {reason}", board.name, taken.display());
            continue;
        }
        emulate(on, &taken, COMPARE)?;
    }
    if board.has_fpu && on.any_scene.is_none() {
        compare_in_fixed_point(board)?;
    }
    compare_with_slow_sensors(on)
}

const COMPARE: &[Task] = &[Task::Compare(Probe::Attached)];

/// Everything that one side can run at once; [`noisiest`] gives it to both.
pub(crate) const FULL: &str = "scenes/full.toml";
/// What a lab flashes, which names no model; a world for it, and a model of that.
pub(crate) const BENCH: &str = "scenes/bench.toml";
pub(crate) const WORLD: &str = "scenes/textures.toml";
const MODEL: &str = "scenes/models/textures.model";
/// Both sides, where contact on one excites the other.
pub(crate) const CIA: &str = "scenes/cia.toml";

/// Of the scenes, those that are compared in fixed point too.
const IN_FIXED_POINT: [&str; 2] = [FULL, CIA];

/// Compares [`IN_FIXED_POINT`] with host-sim in fixed point, which takes programs of their own.
pub(crate) fn compare_in_fixed_point(board: Board) -> Result<(), Fault> {
    for scene in IN_FIXED_POINT {
        let fixed = variants::in_fixed_point(&top().join(scene), &target().join("fixed"))?;
        emulate(&Emulated::linked(board), &fixed, COMPARE)?;
    }
    Ok(())
}

/// Compares [`FULL`] with host-sim where its sensors are in their slow mode, and the board at
/// half its clock for them.
pub(crate) fn compare_with_slow_sensors(on: &Emulated) -> Result<(), Fault> {
    let slow = variants::with_slow_sensors(&top().join(FULL), &target().join("slow"))?;
    emulate(on, &slow, COMPARE)
}

/// Compares [`CIA`] with host-sim where the sensors find their zeros.
pub(crate) fn compare_with_zeros(on: &Emulated) -> Result<(), Fault> {
    let zeros = variants::with_zeros(&top().join(CIA), &target().join("zeros"))?;
    emulate(on, &zeros, COMPARE)
}

/// [`FULL`] on both sides: the noisiest scene. Writes it and returns its path.
pub(crate) fn noisiest() -> Result<PathBuf, Fault> {
    variants::on_both_sides(&top().join(FULL), &target().join("both"))
}
