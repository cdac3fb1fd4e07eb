//! `host-sim` without arguments: trains a whisker on textures and lets it tell them apart.

use std::path::Path;

use scene::Scene;
use tactile::ModelBuf;

use super::run::{self, Played};
use super::with_seed;
use crate::classifier::Classifier;
use crate::output::Output;
use crate::plot::{self, Film};
use crate::progress::Verbosity;
use crate::recording::Stream;
use crate::run::Run;
use crate::training::{How, Tables};
use crate::{Error, files, report};

/// The scene, so that the program runs wherever it stands.
const SCENE: &str = include_str!("../../../scenes/bench-textures.toml");
const OUT: &str = "out/bench-textures";
/// Seconds that are trained on: of 24 presentations of each texture, each in its own pose.
const TRAINING_S: f64 = 240.0;

/// Its scene.
///
/// # Errors
/// None: it is part of the program.
pub fn scene() -> Result<Scene, Error> {
    Scene::from_str("scenes/bench-textures.toml", SCENE).map_err(Error::from)
}

/// Trains on some whisks, decides on others, prints and writes the results.
///
/// # Errors
/// [`Error::Work`] or [`Error::Write`].
pub fn main_job(verbosity: Verbosity) -> Result<(), Error> {
    let scene = scene()?;
    let out = Path::new(OUT);

    let create = |name| Output::create(&out.join(name));
    let (recording, trained) = (create("training.csv")?, create("bench-textures.model")?);
    let (drawn, pixels) = (create("bench-textures.svg")?, create("bench-textures.png")?);

    report::say(format_args!(
        "training: {TRAINING_S} s of whisking against each texture in turn, each time in another pose"
    ));
    let streams = record(&scene, verbosity)?;
    files::write_recording(recording, &streams, scene.tick_hz)?;
    let model = train(&scene, streams)?;
    trained.whole(model.as_bytes())?;

    report::say(format_args!(
        "deciding: {} s of another run, decisions as they are made",
        scene.duration_s
    ));
    let (played, film) = decide(&scene, model, out, verbosity)?;
    let title = plot::title(
        "left whisker: four textures, poses of a bench",
        scene.duration_s,
    );
    let picture = film.picture(&title, &played.classes, &played.decided);
    drawn.whole(picture.svg()?.as_bytes())?;
    pixels.whole(&picture.png()?)?;
    let summary = played.summary().unwrap_or_default();
    report::say(format_args!(
        "\n{summary}\nin {OUT}: trace.csv, decisions.csv, training.csv, bench-textures.model, .svg and .png"
    ));
    Ok(())
}

/// What the classifier of `scene` would have got in another run of it, and a longer one: the
/// same scene with another seed, so other noise, other grit and other poses.
///
/// # Errors
/// [`Error::Work`] if the module cannot be put together.
pub fn record(scene: &Scene, verbosity: Verbosity) -> Result<Vec<Stream>, Error> {
    let mut scene = with_seed(scene, scene.seed.wrapping_add(1));
    scene.duration_s = TRAINING_S;
    super::record::streams(&scene, verbosity)
}

/// The model of a recording with the settings that `host-sim train` has by default.
fn train(scene: &Scene, streams: Vec<Stream>) -> Result<ModelBuf, Error> {
    let recordings = [(scene.name.clone(), streams)];
    let how = How::of(Tables::Joint).like(scene);
    let trained = how.train(&recordings, scene.tick_hz);
    let trained = trained.map_err(|error| Error::Work(format!("training: {error}")))?;
    Ok(trained.model)
}

fn decide(
    scene: &Scene,
    model: ModelBuf,
    out: &Path,
    verbosity: Verbosity,
) -> Result<(Played, Film), Error> {
    let classifier = Classifier::of_scene(model, scene);
    let classifier = classifier.map_err(|fault| Error::Work(fault.to_string()))?;
    let run = Run::new(scene, Some(classifier))?;
    let mut film = Film::default();
    let played = run::play(run, scene, out, verbosity, |run, progress| {
        film.take(run);
        for decided in run.decisions() {
            progress.pause(|| report::decision(&decided, run.classes()));
        }
        Ok(())
    })?;
    Ok((played, film))
}
