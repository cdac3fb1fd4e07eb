//! `host-sim record`: what a classifier would get, to train on.

use std::path::Path;

use scene::Scene;

use super::ahead;
use super::choice::SceneChoice;
use crate::output::{Output, check_apart, check_or_stdout};
use crate::progress::{Progress, Verbosity};
use crate::recording::{Recorder, Stream};
use crate::run::Run;
use crate::{Error, bench, files};

/// About how many bytes a row of a recording has, as of the scenes of the project.
const ROW_BYTES: u64 = 28;

/// Runs a scene and writes what its whiskers feel that are heard to `out`:
/// a recording for `host-sim train`, the air included. Its classifier, if any, is not
/// used. `seed` takes the place of the scene's. `out` may be `-`, standard output.
///
/// # Errors
/// [`Error::Input`] for a scene that is wrong, [`Error::Write`].
pub fn record(
    scene: &SceneChoice,
    out: &Path,
    seed: Option<u64>,
    verbosity: Verbosity,
) -> Result<String, Error> {
    check_or_stdout(out)?;
    check_apart(out, [scene.file.as_path()])?;
    let SceneChoice { file: path, set } = scene;
    let (mut scene, _) = Scene::load_with(path, set)?;
    config::check(&scene).map_err(|refused| Error::file(path, refused))?;
    scene.seed = seed.unwrap_or(scene.seed);
    let output = Output::create_or_stdout(out)?;
    let recording = ("the recording", ROW_BYTES * bench::heard(&scene) as u64);
    ahead::tell(&scene, 1, Some(recording), verbosity);
    let streams = streams(&scene, verbosity)?;
    files::write_recording(output, &streams, scene.tick_hz)?;
    let samples: usize = streams.iter().map(|stream| stream.samples.len()).sum();
    Ok(format!(
        "{}: {samples} samples in {} streams",
        out.display(),
        streams.len()
    ))
}

/// What the classifier of `scene` would get, a stream a presentation and whisker.
///
/// # Errors
/// [`Error::Work`] if the module cannot be put together.
pub fn streams(scene: &Scene, verbosity: Verbosity) -> Result<Vec<Stream>, Error> {
    let mut run = Run::new(scene, None)?;
    let mut recorder = Recorder::default();
    let mut progress = Progress::new(verbosity, "recording", run.ticks());
    for n in 0..run.ticks() {
        run.tick();
        recorder.take(&mut run);
        progress.tick(n);
    }
    Ok(recorder.into_streams())
}
