//! A scene on an emulated board: builds the board's program and runs it there.

pub(crate) mod variants;

use std::path::{Path, PathBuf};
use std::process::Command;

use ::firmware::Part;

use crate::firmware::{self, Board};
use crate::run::{Fault, absolute, emulator, listing, output, run, top};

/// A board, and how it gets its scenes.
#[derive(Debug)]
pub(crate) struct Emulated {
    board: Board,
    /// The program that takes any scene, to which they are deployed; `None`: each is linked into
    /// a program of the parts that it needs.
    any_scene: Option<PathBuf>,
}

impl Emulated {
    pub(crate) const fn linked(board: Board) -> Self {
        Self {
            board,
            any_scene: None,
        }
    }

    pub(crate) fn deployed(board: Board) -> Result<Self, Fault> {
        let any_scene = firmware::build_any_scene(board)?;
        Ok(Self {
            board,
            any_scene: Some(any_scene),
        })
    }

    pub(crate) fn program(&self, scene: &Path) -> Result<PathBuf, Fault> {
        match &self.any_scene {
            Some(program) => Ok(program.clone()),
            None => firmware::build(self.board, scene),
        }
    }

    /// Puts the board with `scene` through `scenarios` of the emulator, one after the other: each is
    /// its name, with its options.
    pub(crate) fn run(&self, scene: impl AsRef<Path>, scenarios: &[&str]) -> Result<(), Fault> {
        let scene = scene.as_ref();
        let program = self.program(scene)?;
        for scenario in scenarios {
            let mut command = emulator(&format!("scenario {scenario}"));
            match *scenario {
                "telemetry" => {
                    let without = self.program(&variants::without_telemetry(scene)?)?;
                    command.arg("--without").arg(without);
                }
                "serial" => {
                    serial(self, scene, &program, &mut command)?;
                    run(&mut command)?;
                    continue;
                }
                _ if scenario.starts_with("stopping") => {
                    let fast = variants::with_serial(scene, SERIAL_BAUDS[0])?;
                    command.arg(absolute(&fast)?);
                    run(command.arg("--program").arg(self.program(&fast)?))?;
                    continue;
                }
                "deploying" => {
                    command.arg("--world").arg(top().join(WORLD));
                    command.arg("--model").arg(top().join(MODEL));
                }
                _ => {}
            }
            run(command.arg(absolute(scene)?).arg("--program").arg(&program))?;
        }
        Ok(())
    }
}

pub(crate) fn files(on: &Emulated, scene: &Path, out: &Path) -> Result<(), Fault> {
    let mut command = emulator("run --out");
    command.arg(absolute(out)?).arg(absolute(scene)?);
    run(command.arg("--program").arg(on.program(scene)?))
}

/// Runs `scene` against what `scenario` lists, in its own world or another, and writes what became
/// of it to `json`. Files that are wrong end this program as they end the emulator's, before
/// anything is built.
pub(crate) fn tried(
    on: &Emulated,
    scene: &Path,
    scenario: &Path,
    world: Option<&Path>,
    json: &Path,
) -> Result<(), Fault> {
    let mut command = trial(scene, scenario, json)?;
    if let Some(world) = world {
        command.arg("--world").arg(absolute(world)?);
    }
    let checked = command.status().map_err(|error| error.to_string())?;
    if !checked.success() {
        std::process::exit(checked.code().unwrap_or(1));
    }
    run(command.arg("--program").arg(on.program(scene)?))
}

/// The command that does so in its own world, without the program.
pub(crate) fn trial(scene: &Path, scenario: &Path, json: &Path) -> Result<Command, Fault> {
    let mut command = emulator("try");
    command.arg(absolute(scene)?);
    for (option, path) in [("--scenario", scenario), ("--json", json)] {
        command.arg(option).arg(absolute(path)?);
    }
    Ok(command)
}

/// Bits a second that carry the records of one whisker at 2 kHz, and of two; and the
/// ST-LINK's default, that carries neither.
const SERIAL_BAUDS: [u32; 3] = [921_600, 2_000_000, 115_200];

/// The options by which a board talks over its serial line at two of [`SERIAL_BAUDS`]; `without`
/// is the program of the scene itself.
fn serial(on: &Emulated, scene: &Path, without: &Path, to: &mut Command) -> Result<(), Fault> {
    let [one, two, slow] = SERIAL_BAUDS;
    let is_one = variants::load(scene)?.whiskers() == 1;
    let fast = variants::with_serial(scene, if is_one { one } else { two })?;
    let slow = variants::with_serial(scene, slow)?;
    to.arg(absolute(&fast)?);
    to.arg("--program").arg(on.program(&fast)?);
    to.arg("--slow").arg(on.program(&slow)?);
    to.arg("--without").arg(without);
    Ok(())
}

/// Draws what both sides do in `scenes`, deployed to the board one after the other, to the SVG file
/// `out`.
pub(crate) fn picture(board: Board, scenes: &[PathBuf], out: &Path) -> Result<(), Fault> {
    let mut command = emulator("picture");
    let program = firmware::build_any_scene(board)?;
    for scene in scenes {
        command.arg(absolute(scene)?).arg("--program").arg(&program);
    }
    run(command.arg("--out").arg(absolute(out)?))
}

/// What the scenario `deadlines` measures, as `what,mean,worst` lines.
pub(crate) fn deadlines(board: Board, scene: &Path, minutes: f64) -> Result<String, Fault> {
    let program = firmware::build(board, scene)?;
    let mut command = emulator("--quiet scenario deadlines --csv --minutes");
    command.arg(minutes.to_string());
    output(command.arg(top().join(scene)).arg("--program").arg(program))
}

/// Compares every scene in `scenes` that the board takes with host-sim; one with several
/// whiskers a side by the first of each. [`IN_FIXED_POINT`] are compared in fixed point
/// too, where a board has a choice and scenes are linked.
pub(crate) fn compare_all(on: &Emulated) -> Result<(), Fault> {
    let board = on.board;
    for scene in listing(&top().join("scenes"), "toml")? {
        let taken = variants::single(&scene)?;
        let path = taken.display();
        let linked = match firmware::linked(board, &taken)? {
            Ok(linked) => linked,
            Err(reason) => {
                println!("not on the {}: {path}: {reason}", board.name);
                continue;
            }
        };
        let parts = linked.image.features;
        if on.any_scene.is_some() && parts.contains(&Part::Tmag5170.feature()) {
            let part = Part::Tmag5170;
            println!("not by the program for any scene: {path}: {part}");
            continue;
        }
        on.run(taken, COMPARE)?;
    }
    if board.facts.has_fpu && on.any_scene.is_none() {
        for scene in IN_FIXED_POINT {
            on.run(variants::with(scene, &FIXED)?, COMPARE)?;
        }
    }
    on.run(with_slow_sensors()?, COMPARE)
}

const COMPARE: &[&str] = &["compare"];

/// Everything that one side can run at once; [`noisiest`] gives it to both.
pub(crate) const FULL: &str = "scenes/full.toml";
/// What a lab flashes, which names no model; a world for it, and a model of that.
pub(crate) const BENCH: &str = "scenes/bench.toml";
pub(crate) const WORLD: &str = "scenes/textures.toml";
const MODEL: &str = "scenes/models/textures.model";
/// Both sides, where contact on one excites the other.
pub(crate) const CIA: &str = "scenes/cia.toml";

/// One whose model has a second opinion.
pub(crate) const JUDGED: &str = "scenes/bench-textures.toml";

/// The main job with TMAG5170s.
pub(crate) const TILT: &str = "scenes/tmag5170.toml";

/// Of the scenes, those that are compared in fixed point too, which takes programs of their own.
const IN_FIXED_POINT: [&str; 2] = [FULL, CIA];
pub(crate) const FIXED: [&str; 1] = ["whisking.numbers=fixed"];

/// [`TILT`] on every side of the board.
pub(crate) fn tilt(board: Board) -> Result<PathBuf, Fault> {
    let scene = top().join(TILT);
    if board.facts.max_sides > 1 {
        variants::on_both_sides(&scene)
    } else {
        Ok(scene)
    }
}

/// [`JUDGED`] on both sides with what no scene of `scenes/` asks for: sensors that find their zeros,
/// which are not at mid-scale, contact without self-motion, priors and thresholds of the model's
/// classes, and poses.
pub(crate) fn judged_with_options() -> Result<PathBuf, Fault> {
    let keys = [
        "sensor.zero_after_s=0.5",
        "sensor.self_motion_s=1.0",
        "plant.zero_codes=[[40.0, -60.0], [-90.0, 30.0]]",
        "classifier.pose=true",
        "classifier.prior.smooth=0.6",
        "classifier.thresholds.carpet=0.999",
    ];
    variants::with(variants::on_both_sides(&top().join(JUDGED))?, &keys)
}

/// [`FULL`] where its sensors are in their slow mode, and the board at half its clock for them.
pub(crate) fn with_slow_sensors() -> Result<PathBuf, Fault> {
    variants::with_slow_sensors(&top().join(FULL))
}

/// [`FULL`] with a brushless motor, which no scene of `scenes/` has.
pub(crate) fn brushless() -> Result<PathBuf, Fault> {
    variants::with(FULL, &["motor.driver=six-step"])
}

/// [`CIA`] on a board a side, which a bus joins.
pub(crate) fn head_of_two() -> Result<PathBuf, Fault> {
    variants::with(CIA, &["head.nodes=2"])
}

/// [`FULL`] on both sides: the noisiest scene.
pub(crate) fn noisiest() -> Result<PathBuf, Fault> {
    variants::on_both_sides(&top().join(FULL))
}
