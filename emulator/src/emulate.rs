//! One scene on the emulated board, to the files that host-sim writes.

use std::fmt::Write as _;
use std::path::Path;

use host_sim::Error;
use host_sim::commands::run::play;
use host_sim::output::Output;
use host_sim::plot::{self, Film};
use host_sim::progress::Verbosity;
use host_sim::run::Run;
use host_sim::world::World;
use scene::{Rule, Scene, SensorMode};

use crate::board::Board;
use crate::chip::{Fault, Model};
use crate::deployment::{flashed, image};
use crate::program::Program;
use crate::session::Session;

impl From<Fault> for Error {
    fn from(fault: Fault) -> Self {
        match fault {
            // It was given as a file.
            Fault::Program(_) => Self::Input(fault.to_string()),
            _ => Self::Work(format!("emulated board: {fault}")),
        }
    }
}

/// Counts of a period of the motors' PWM, and of so many Hz: half as many where the core's clock
/// is halved for slow sensors.
pub(crate) fn pwm_counts(scene: &Scene, model: &Model) -> u16 {
    let is_slow = scene.sensor.mode == SensorMode::Slow;
    model.facts.clocks_of(is_slow).pwm_counts()
}

/// A scene on the emulated board, which may have none, or refuse it, before its first tick; `classes`
/// are those of the program's classifier.
pub(crate) fn start(
    scene: &Scene,
    classes: Vec<String>,
    program: &Program,
) -> Result<Run<Board>, Error> {
    let model = program.model()?;
    // What hangs on the board, by whichever model it decides.
    image(&without_class_settings(scene), None, model.facts)?;
    let (world, pins) = World::wired(scene, pwm_counts(scene, model))?;
    let sides = 0..scene.head.sides.count();
    let board = Board::new(program, scene, (0, sides), pins)?;
    let mut chip = board.machine.chip();
    chip.attach_serial(scene.telemetry.serial_baud);
    drop(chip);
    Ok(Run::of(scene, Box::new(board), classes, world))
}

fn without_class_settings(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    if let Some(classifier) = &mut scene.classifier {
        (classifier.prior, classifier.thresholds) = (None, None);
        if let Rule::Costs { .. } = classifier.rule {
            classifier.rule = Rule::Sequential { threshold: 0.99 };
        }
    }
    scene
}

/// Runs the scene in `path` on the board that `program` was built for; writes
/// `out/trace.csv` and its picture, `out/trace.svg`, `out/log.txt`, and `out/decisions.csv`
/// where the scene classifies. Returns the score of the decisions, where there are any to score.
pub(crate) fn emulate(
    path: &Path,
    program: &Path,
    out: &Path,
    verbosity: Verbosity,
) -> Result<Option<String>, Error> {
    let (loaded, program) = flashed(path, program)?;
    let classes = loaded.classes()?;
    let Session { run, .. } = Session::running(&loaded.scene, classes, &program)?;
    let written = Output::create(&out.join("log.txt"))?;
    let drawn = Output::create(&out.join("trace.svg"))?;
    let mut film = Film::default();
    let mut log = String::new();
    let scene = &loaded.scene;
    let done = play(run, scene, out, verbosity, |run, _| {
        film.take(run);
        let board = run.module_mut();
        for line in board.lines() {
            // Writing to a string does not fail.
            let _ = writeln!(log, "{line}");
        }
        Ok(board.check()?)
    });
    // Where something went wrong the log says what led to it.
    written.whole(log.as_bytes())?;
    let played = done?;
    let title = plot::title(&scene.name, scene.duration_s);
    let picture = film.picture(&title, &played.classes, &played.decided);
    drawn.whole(picture.svg()?.as_bytes())?;
    Ok(played.summary())
}
