//! A scene on an emulated board: builds the board's program and runs it there.

pub(crate) mod variants;

use std::path::{Path, PathBuf};

use clap::ValueEnum;

use crate::firmware::{self, Board};
use crate::run::{Fault, absolute, listing, output, run, top, workspace_program};

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
    tasks
        .iter()
        .try_for_each(|task| one(on, scene, (&program, task)))
}

/// Does a task with a scene and its program.
fn one(on: &Emulated, scene: &Path, (program, task): (&Path, &Task)) -> Result<(), Fault> {
    let mut command = workspace_program("emulator");
    match task {
        Task::Run(out) => command.args(["run", "--out"]).arg(absolute(out)?),
        Task::Compare(Probe::Attached) => command.arg("compare"),
        Task::Compare(Probe::Absent) => command.args(["compare", "--probe", "absent"]),
        Task::Compare(Probe::Pulled) => command.args(["compare", "--probe", "pulled"]),
        Task::Deadlines(minutes) => command.args(["deadlines", "--minutes", &minutes.to_string()]),
        Task::Overload => command.arg("overload"),
        Task::Starting => command.arg("starting"),
        Task::Supply => command.arg("supply"),
        Task::Telemetry => {
            let without = on.program(&variants::without_telemetry(scene)?)?;
            command.args(["telemetry", "--without"]).arg(without)
        }
        Task::Serial => return serial(on, scene, program),
        Task::Damage => command.arg("damage"),
        Task::SensorLoss => command.arg("sensor-loss"),
        Task::Latency => command.arg("latency"),
        Task::Deploying => {
            command
                .args(["deploying", "--world"])
                .arg(top().join(WORLD));
            command.arg("--model").arg(top().join(MODEL))
        }
    };
    run(command.arg(absolute(scene)?).arg("--program").arg(program))
}

/// Bits a second that carry the records of one whisker at 2 kHz, and of two; and the
/// ST-LINK's default, that carries neither.
const SERIAL_BAUDS: [u32; 3] = [921_600, 2_000_000, 115_200];

/// Talks with a board over its serial line at two of [`SERIAL_BAUDS`]; `without` is the program
/// of the scene itself.
fn serial(on: &Emulated, scene: &Path, without: &Path) -> Result<(), Fault> {
    let [one, two, slow] = SERIAL_BAUDS;
    let is_one = variants::whiskers(scene)? == 1;
    let fast = variants::with_serial(scene, if is_one { one } else { two })?;
    let slow = variants::with_serial(scene, slow)?;
    let mut command = workspace_program("emulator");
    command.arg("serial").arg(absolute(&fast)?);
    command.arg("--program").arg(on.program(&fast)?);
    command.arg("--slow").arg(on.program(&slow)?);
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
        let taken = variants::single(&scene)?;
        if let Err(reason) = firmware::linked(board, &taken)? {
            println!("not on the {}: {}: {reason}", board.name, taken.display());
            continue;
        }
        emulate(on, &taken, COMPARE)?;
    }
    if board.facts.has_fpu && on.any_scene.is_none() {
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
        let fixed = variants::in_fixed_point(&top().join(scene))?;
        emulate(&Emulated::linked(board), &fixed, COMPARE)?;
    }
    Ok(())
}

/// Compares [`FULL`] with host-sim where its sensors are in their slow mode, and the board at
/// half its clock for them.
pub(crate) fn compare_with_slow_sensors(on: &Emulated) -> Result<(), Fault> {
    let slow = variants::with_slow_sensors(&top().join(FULL))?;
    emulate(on, &slow, COMPARE)
}

/// Compares [`CIA`] with host-sim where the sensors find their zeros.
pub(crate) fn compare_with_zeros(on: &Emulated) -> Result<(), Fault> {
    let zeros = variants::with_zeros(&top().join(CIA))?;
    emulate(on, &zeros, COMPARE)
}

/// [`FULL`] on both sides: the noisiest scene. Writes it and returns its path.
pub(crate) fn noisiest() -> Result<PathBuf, Fault> {
    variants::on_both_sides(&top().join(FULL))
}
