//! `host-sim run`: one scene to its files.

use std::fmt::Display;
use std::path::Path;

use scene::Scene;

use crate::decisions::{self, Confusion, Decided};
use crate::listening;
use crate::progress::{Progress, Verbosity};
use crate::run::{Happened, Run};
use crate::trace::TraceFile;
use crate::{Error, report};

/// Runs the scene in `path`; writes `out/trace.csv`, and `out/decisions.csv`
/// where the scene classifies.
///
/// # Errors
/// [`Error::Input`] for a scene or model that is wrong, otherwise what writing brings.
pub fn run(path: &Path, out: &Path, verbosity: Verbosity) -> Result<(), Error> {
    let scene = Scene::load(path)?;
    let folder = path.parent().unwrap_or(Path::new("."));
    let model = scene
        .model_path(folder)
        .map(|path| listening::load(&path))
        .transpose()?;
    let (listener, classes) = match (&scene.classifier, &model) {
        (Some(classifier), Some((model_path, model))) => {
            let wrong = |fault: &dyn Display| Error::file(model_path, fault);
            let model = model.model().map_err(|error| wrong(&error))?;
            let listener = listening::classifier(&model, classifier.rule);
            (
                Some(listener.map_err(|fault| wrong(&fault))?),
                listening::names(&model),
            )
        }
        _ => (None, Vec::new()),
    };

    let mut run = Run::new(&scene, listener)?;
    let mut trace = TraceFile::create(&out.join("trace.csv"))?;
    let mut decided: Vec<Decided> = Vec::new();
    let mut happened = Happened::default();
    let mut progress = Progress::new(verbosity, "simulating", run.ticks());
    for n in 0..run.ticks() {
        let row = *run.tick(&mut happened);
        trace.row(&row)?;
        for event in &happened.events {
            report::limits_and_faults(row.t_s, event);
        }
        decided.extend(run.decided(&happened, &classes));
        if n.is_multiple_of(1024) {
            progress.set(n);
        }
    }
    drop(progress);

    if scene.classifier.is_some() {
        decisions::write(&out.join("decisions.csv"), &decided)?;
    }
    trace.finish()?;
    if scene.classifier.is_some() {
        print!(
            "{}",
            report::Summary(&Confusion::new(&classes, &decided), scene.tick_hz)
        );
    }
    Ok(())
}
