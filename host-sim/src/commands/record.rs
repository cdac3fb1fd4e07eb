//! `host-sim record`: what a classifier would hear, to learn from.

use std::cell::RefCell;
use std::path::Path;
use std::rc::Rc;

use firmware::SampleClassifier;
use scene::Scene;
use tactile::Decision;

use crate::Error;
use crate::bench::AnyListener;
use crate::progress::{Progress, Verbosity};
use crate::recording::{self, Stream};
use crate::run::{Happened, Run};

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

/// Listens without deciding: keeps the codes.
struct Recorder(Rc<RefCell<Vec<[f64; 2]>>>);

impl SampleClassifier for Recorder {
    fn push(&mut self, codes: [u16; 2]) -> Option<Decision> {
        self.0.borrow_mut().push(codes.map(f64::from));
        None
    }

    fn reset(&mut self) {}
}

/// What the classifier of `scene` would hear, a stream a presentation.
///
/// # Errors
/// [`Error::Work`] if the module cannot be put together.
pub fn streams(scene: &Scene, verbosity: Verbosity) -> Result<Vec<Stream>, Error> {
    let heard = Rc::new(RefCell::new(Vec::new()));
    let recorder = AnyListener(Box::new(Recorder(Rc::clone(&heard))));
    let mut run = Run::new(scene, Some(recorder))?;
    let mut happened = Happened::default();
    let mut streams: Vec<Stream> = Vec::new();
    let mut progress = Progress::new(verbosity, "recording", run.ticks());
    for n in 0..run.ticks() {
        run.tick(&mut happened);
        let (label, trial) = run.presented();
        let trial = trial.to_string();
        let samples = std::mem::take(&mut *heard.borrow_mut());
        match streams
            .last_mut()
            .filter(|last| last.label == label && last.trial == trial)
        {
            Some(stream) => stream.samples.extend(samples),
            None => streams.push(Stream {
                label: label.to_owned(),
                trial,
                samples,
            }),
        }
        if n.is_multiple_of(1024) {
            progress.set(n);
        }
    }
    Ok(streams)
}
