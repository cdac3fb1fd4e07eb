//! `host-sim` without arguments: trains a whisker on textures and lets it tell them apart.

use std::path::Path;

use scene::Scene;
use tactile::ModelBuf;

use super::train::{How, Tables};
use crate::classifier::Classifier;
use crate::decisions::Score;
use crate::files::{self, TraceFile};
use crate::output::write_whole;
use crate::plot::{self, Mark, Picture, Presented};
use crate::progress::{Progress, Verbosity};
use crate::recording::Stream;
use crate::run::Run;
use crate::trace::Row;
use crate::{Error, report};

/// The scene, so that the program runs wherever it stands.
const SCENE: &str = include_str!("../../../scenes/textures.toml");
/// Where the files go.
const OUT: &str = "out/textures";
/// How much of the run the plot shows, s: a presentation of each texture.
const PLOTTED_S: f64 = 10.0;

/// Trains on some whisks, decides on others, prints and writes the results.
///
/// # Errors
/// [`Error::Work`] or [`Error::Write`].
pub fn main_job(verbosity: Verbosity) -> Result<(), Error> {
    let scene = Scene::from_str("scenes/textures.toml", SCENE)?;
    let out = Path::new(OUT);

    report::say(format_args!(
        "training: {} s of whisking against each texture in turn",
        scene.duration_s
    ));
    let streams = record(&scene, verbosity)?;
    files::write_recording(&out.join("training.csv"), &streams)?;
    let model = train(&scene, streams)?;
    write_whole(&out.join("textures.model"), model.as_bytes())?;

    report::say(format_args!(
        "deciding: {} s of another run, decisions as they are made",
        scene.duration_s
    ));
    let deciding = decide(&scene, model, out, verbosity)?;
    let marks = &deciding.marks;
    let decided: Vec<_> = marks.iter().map(|mark| mark.decided.clone()).collect();
    files::write_decisions(&out.join("decisions.csv"), &decided)?;
    let picture = Picture {
        title: "left whisker: four textures, RCP",
        rows: &deciding.rows,
        classes: &deciding.classes,
        presented: &deciding.presented,
        marks,
    };
    let svg =
        plot::left_whisker(&picture).map_err(|error| Error::Work(format!("plot: {error}")))?;
    write_whole(&out.join("textures.svg"), svg.as_bytes())?;

    let score = Score::new(&deciding.classes, &decided);
    let summary = report::Summary(&score, scene.tick_hz);
    report::say(format_args!(
        "\n{summary}\nin {OUT}: trace.csv, decisions.csv, training.csv, textures.model, textures.svg"
    ));
    Ok(())
}

/// What the classifier of `scene` would have got in another run of it: the
/// same scene with another seed, so other noise and other grit.
///
/// # Errors
/// [`Error::Work`] if the module cannot be put together.
pub fn record(scene: &Scene, verbosity: Verbosity) -> Result<Vec<Stream>, Error> {
    let scene = Scene {
        seed: scene.seed.wrapping_add(1),
        ..scene.clone()
    };
    super::record::streams(&scene, verbosity)
}

/// The model of a recording with the settings that `host-sim train` has by default.
fn train(scene: &Scene, streams: Vec<Stream>) -> Result<ModelBuf, Error> {
    let recordings = [(scene.name.clone(), streams)];
    let trained = How::of(Tables::Joint).train(&recordings, scene.tick_hz);
    let trained = trained.map_err(|error| Error::Work(format!("training: {error}")))?;
    Ok(trained.model)
}

/// A run with decisions.
struct Deciding {
    classes: Vec<String>,
    marks: Vec<Mark>,
    presented: Vec<Presented>,
    /// The rows to be plotted.
    rows: Vec<Row>,
}

fn decide(
    scene: &Scene,
    model: ModelBuf,
    out: &Path,
    verbosity: Verbosity,
) -> Result<Deciding, Error> {
    let Some(classifier) = &scene.classifier else {
        return Err(Error::Work("the scene has no classifier".to_owned()));
    };
    let classifier =
        Classifier::new(model, classifier.rule).map_err(|fault| Error::Work(fault.to_string()))?;
    let mut run = Run::new(scene, Some(classifier))?;
    let mut trace = TraceFile::create(&out.join("trace.csv"))?;
    let (mut marks, mut rows) = (Vec::new(), Vec::new());
    let mut presented: Vec<Presented> = Vec::new();
    let mut progress = Progress::new(verbosity, "deciding", run.ticks());
    for n in 0..run.ticks() {
        let row = run.tick();
        trace.row(&row)?;
        if row.t_s <= PLOTTED_S {
            rows.push(row);
        }
        for event in run.events() {
            report::limits_and_faults(row.t_s, event);
        }
        let (label, _) = run.presented();
        match presented.last_mut().filter(|last| last.label == label) {
            Some(last) => last.span_s.1 = row.t_s,
            None => presented.push(Presented {
                span_s: (row.t_s, row.t_s),
                label: label.to_owned(),
            }),
        }
        if let Some(decided) = run.decision() {
            progress.pause(|| report::decision(row.t_s, &decided));
            marks.push(Mark {
                t_s: row.t_s,
                decided,
            });
        }
        progress.tick(n);
    }
    trace.finish()?;
    Ok(Deciding {
        classes: run.classes().to_vec(),
        marks,
        presented,
        rows,
    })
}
