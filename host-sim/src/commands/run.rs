//! `host-sim run`: one scene to its files.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use scene::{Override, Rule, Scene};

use super::choice::{SceneChoice, seed};
use super::{ahead, any_picture, ends_in};
use crate::bench::Bench;
use crate::classifier::Classifier;
use crate::decisions::{Columns, Decided, Score};
use crate::loaded::Loaded;
use crate::output::{self, Output, is_stdout};
use crate::plot::{self, Film};
use crate::progress::{Progress, Verbosity};
use crate::run::Run;
use crate::trace::{TraceShape, TraceWriter};
use crate::{Error, files, report};

/// What to run, and where to write.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Which scene
    #[command(flatten)]
    pub scene: SceneChoice,
    /// Another seed than the scene's
    #[arg(long, value_name = "N", value_parser = seed)]
    pub seed: Option<u64>,
    /// The model that its module decides by, where the scene names none
    #[arg(long, value_name = "FILE")]
    pub model: Option<PathBuf>,
    /// The scene in whose world it runs: what its whiskers meet, for how long, and the seed; --set
    /// sets keys of these there
    #[arg(long, value_name = "SCENE")]
    pub world: Option<PathBuf>,
    /// Where to write
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Where else to write the picture of the first ten seconds, besides DIR/trace.svg and
    /// DIR/trace.png
    #[arg(long, value_name = "FILE.svg|FILE.png", value_parser = any_picture)]
    pub plot: Option<PathBuf>,
    /// Draws no picture
    #[arg(long, conflicts_with = "plot")]
    pub no_plot: bool,
}

impl Arguments {
    /// A scene as its file has it, its tables going to `out`; no picture.
    pub fn of(scene: &Path, out: &Path) -> Self {
        Self {
            scene: scene.to_owned().into(),
            seed: None,
            model: None,
            world: None,
            out: out.to_owned(),
            plot: None,
            no_plot: true,
        }
    }
}

/// About how many bytes a cell of a trace has, as of the scenes of the project.
const CELL_BYTES: u64 = 7;

/// Runs a scene; writes `trace.csv`, `decisions.csv` where its module has a model, and
/// pictures of the first ten seconds. Returns what was done: the score of the decisions,
/// where there are any to score, and where all of it is.
///
/// # Errors
/// [`Error::Input`] for a scene or model that is wrong, [`Error::Write`].
pub fn run(arguments: &Arguments, verbosity: Verbosity) -> Result<String, Error> {
    let Arguments { out, no_plot, .. } = arguments;
    let plot = arguments.plot.as_deref();
    if is_stdout(out) {
        return Err(Error::file(out, "a run has several files; name a folder"));
    }
    if let Some(plot) = plot {
        output::check(plot)?;
        let files = [&arguments.model, &arguments.world].into_iter().flatten();
        let files = files.chain([&arguments.scene.file]);
        output::check_apart(plot, files.map(PathBuf::as_path))?;
    }
    let SceneChoice { file, set } = arguments.scene.clone();
    let is_of_world = |one: &Override| {
        let key = one.key();
        arguments.world.is_some()
            && (key.starts_with("plant.") || ["duration_s", "seed"].contains(&key))
    };
    let (of_world, set): (Vec<_>, _) = set.into_iter().partition(is_of_world);
    let mut loaded = Loaded::with(&SceneChoice { file, set })?;
    if let Some(world) = &arguments.world {
        loaded = loaded.placed(world, &Scene::load_with(world, &of_world)?.0)?;
    }
    if let Some(model) = &arguments.model {
        loaded = loaded.with_model(model)?;
    }
    if let Some(caution) = loaded.without_model() {
        report::warn(format_args!("{caution}; --model FILE gives one"));
    }
    loaded.scene.seed = arguments.seed.unwrap_or(loaded.scene.seed);
    let scene = &loaded.scene;
    let classifier = loaded.classifier()?;
    let by_costs = classifier
        .as_ref()
        .and_then(|classifier| by_costs(scene, classifier));
    let run = Run::new(scene, classifier)?;
    let beside = ["trace.svg", "trace.png"].map(|name| out.join(name));
    let pictures = beside.iter().filter(|_| !no_plot).map(PathBuf::as_path);
    let pictures: Vec<&Path> = pictures.chain(plot).collect();
    let drawn = pictures.iter().map(|path| Output::create(path));
    let drawn: Vec<Output> = drawn.collect::<Result<_, Error>>()?;
    let row_bytes = CELL_BYTES * TraceShape::of(scene).names().len() as u64;
    ahead::tell(scene, 1, Some(("the trace", row_bytes)), verbosity);
    let mut film = Film::default();
    let mut carried = None;
    let played = play(run, scene, out, verbosity, |run, _| {
        carried = run.bus().map(|bus| bus.load());
        if !pictures.is_empty() {
            film.take(run);
        }
        Ok(())
    })?;
    let title = plot::title(&scene.name, scene.duration_s);
    let picture = film.picture(&title, &played.classes, &played.decided);
    for (output, path) in drawn.into_iter().zip(&pictures) {
        if ends_in(path, "png") {
            output.whole(&picture.png()?)?;
        } else {
            output.whole(picture.svg()?.as_bytes())?;
        }
    }
    let mut summary = played.summary().map_or(String::new(), |score| score + "\n");
    // Writing to a string does not fail.
    let _ = write!(
        summary,
        "{}: {} s simulated, {} ticks, seed {}\nin {}: trace.csv",
        scene.name,
        scene.duration_s,
        scene.ticks(),
        scene.seed,
        out.display()
    );
    if !played.classes.is_empty() {
        summary.push_str(", decisions.csv");
    }
    if !no_plot {
        summary.push_str(", trace.svg, trace.png");
    }
    let motor = scene.motor.as_ref();
    if motor.is_some_and(|motor| !motor.arms_at_start()) {
        summary.push_str(
            "\nits motors were not armed: the scene waits for a command; \
             --set motor.arm=at-start has them armed",
        );
    }
    if let Some(thresholds) = by_costs {
        let _ = write!(summary, "\nthresholds by costs: {thresholds}");
    }
    if let Some(load) = carried {
        let busy = 100.0 * load.busy_s / scene.duration_s;
        let _ = write!(summary, "\nbus: {busy:.1} % of the time, {load}");
    }
    if let Some(picture) = pictures.last() {
        let _ = write!(summary, "\nto look at next: {}", picture.display());
        summary.push_str("; what each column is: host-sim columns");
    }
    Ok(summary)
}

/// What costs come to: the threshold of each class.
fn by_costs(scene: &Scene, classifier: &Classifier) -> Option<String> {
    let rule = scene.classifier.as_ref()?.rule;
    matches!(rule, Rule::Costs { .. }).then(|| {
        let classes = classifier.classes().iter().zip(classifier.settings());
        let each = classes.map(|(name, of)| format!("{name} {:.6}", of.theta()));
        each.collect::<Vec<_>>().join(", ")
    })
}

impl Loaded {
    /// Reads and checks the scene in `path`; cautions go to standard error.
    ///
    /// # Errors
    /// [`Error::Input`] for a scene or model that is wrong.
    pub fn new(path: &Path) -> Result<Self, Error> {
        Self::with(&path.to_owned().into())
    }

    /// The same with keys in place of the file's.
    pub(crate) fn with(SceneChoice { file, set }: &SceneChoice) -> Result<Self, Error> {
        let loaded = Self::checked(file, set)?;
        if let Some(caution) = loaded.caution() {
            report::warn(caution);
        }
        Ok(loaded)
    }

    /// The same without its cautions.
    ///
    /// # Errors
    /// As [`Loaded::new`].
    pub fn checked(path: &Path, set: &[Override]) -> Result<Self, Error> {
        let read = Scene::load_with(path, set)?;
        let folder = path.parent().unwrap_or(Path::new("."));
        Self::of(path, read, |scene| {
            let path = scene.model_path(folder)?;
            Some(files::load_model(&path))
        })
    }

    /// The same module in the world of the scene in `path`.
    ///
    /// # Errors
    /// [`Error::Input`] for a scene that is wrong, or a world that does not fit the module.
    pub fn in_world(self, path: &Path) -> Result<Self, Error> {
        self.placed(path, &Scene::load(path)?)
    }

    fn placed(mut self, path: &Path, world: &Scene) -> Result<Self, Error> {
        let placed = self.scene.in_world(world);
        self.scene = placed.map_err(|fault| Error::file(path, fault))?;
        Ok(self)
    }

    /// The same module with the model in `path` deployed, where its scene names none.
    ///
    /// # Errors
    /// [`Error::Input`] for a model that is wrong, and for a scene that has no use for it.
    pub fn with_model(self, path: &Path) -> Result<Self, Error> {
        self.takes_model()?;
        let (path, model) = files::load_model(path)?;
        Ok(self.with_deployed(&path, Some(model)))
    }
}

/// What was decided in a run.
#[derive(Debug)]
pub struct Played {
    /// The decisions; none where the scene does not classify.
    pub decided: Vec<Decided>,
    /// Names of the classes.
    pub classes: Vec<String>,
    tick_hz: u32,
    classifies: bool,
}

impl Played {
    /// The score, where there is anything to score.
    pub fn summary(&self) -> Option<String> {
        self.classifies.then(|| {
            let score = Score::new(&self.classes, &self.decided);
            report::summary(&score, Some(self.tick_hz))
        })
    }
}

/// Plays a scene to its end and writes its files, as [`run`] does. `after` is
/// called after each tick and can end the run with an error.
///
/// # Errors
/// [`Error::Write`], and what `after` returns.
pub fn play<B: Bench + ?Sized>(
    mut run: Run<B>,
    scene: &Scene,
    out: &Path,
    verbosity: Verbosity,
    mut after: impl FnMut(&mut Run<B>, &Progress) -> Result<(), Error>,
) -> Result<Played, Error> {
    let path = out.join("trace.csv");
    let failed = |source| Error::write(&path, source);
    let trace = TraceWriter::new(Output::create(&path)?, TraceShape::of(scene));
    let mut trace = trace.map_err(failed)?;
    let decides = scene.classifier.is_some() && !run.classes().is_empty();
    let table = decides.then(|| Output::create(&out.join("decisions.csv")));
    let table = table.transpose()?;
    let mut decided: Vec<Decided> = Vec::new();
    let mut whiskers = Vec::new();
    let mut progress = Progress::new(verbosity, "simulating", run.ticks());
    for n in 0..run.ticks() {
        let row = run.tick();
        after(&mut run, &progress)?;
        let first = decided.len();
        decided.extend(run.decisions());
        run.look_at_whiskers(&mut whiskers);
        let fell = decided.get(first..).unwrap_or_default();
        let line = run.trace_line(fell, &whiskers);
        trace.line(&line).map_err(failed)?;
        for event in run.events() {
            report::limits_and_faults(row.t_s, event);
        }
        progress.tick(n);
    }
    drop(progress);

    let classifies = table.is_some();
    if let Some(table) = table {
        files::write_decisions(table, &decided, Columns::of_scene(scene))?;
    }
    trace.into_inner().finish()?;
    Ok(Played {
        decided,
        classes: run.classes().to_vec(),
        tick_hz: scene.tick_hz,
        classifies,
    })
}
