//! `host-sim record`: what a classifier would hear, to learn from.

use std::path::Path;

use scene::Scene;

use crate::Error;
use crate::progress::{Progress, Verbosity};
use crate::recording::{self, Stream};
use crate::run::Run;

/// Runs the scene in `path` and writes what its first whisker feels to `out`:
/// a recording for `host-sim train`. Its classifier, if any, is not used but
/// for `contact_min`. `seed` takes the place of the scene's.
///
/// # Errors
/// [`Error::Input`] for a scene that is wrong, [`Error::Write`].
pub fn record(
    path: &Path,
    out: &Path,
    seed: Option<u64>,
    verbosity: Verbosity,
) -> Result<String, Error> {
    let mut scene = Scene::load(path)?;
    plan::check(&scene).map_err(|refused| Error::file(path, refused))?;
    scene.seed = seed.unwrap_or(scene.seed);
    let streams = streams(&scene, verbosity)?;
    recording::write(out, &streams)?;
    let samples: usize = streams.iter().map(|stream| stream.samples.len()).sum();
    Ok(format!(
        "{}: {samples} samples in {} streams",
        out.display(),
        streams.len()
    ))
}

/// What the classifier of `scene` would hear, a stream a presentation.
///
/// # Errors
/// [`Error::Work`] if the module cannot be put together.
pub fn streams(scene: &Scene, verbosity: Verbosity) -> Result<Vec<Stream>, Error> {
    let mut run = Run::new(scene, None)?;
    let mut streams: Vec<Stream> = Vec::new();
    let mut progress = Progress::new(verbosity, "recording", run.ticks());
    for n in 0..run.ticks() {
        run.tick();
        let (label, trial) = run.presented();
        let trial = trial.to_string();
        let samples = run.sample().map(|codes| codes.map(f64::from));
        match streams
            .last_mut()
            .filter(|last| last.label == label && last.trial == trial)
        {
            Some(stream) => stream.samples.extend(samples),
            None => streams.push(Stream {
                label: label.to_owned(),
                trial,
                samples: samples.into_iter().collect(),
            }),
        }
        if n.is_multiple_of(1024) {
            progress.set(n);
        }
    }
    Ok(streams)
}
