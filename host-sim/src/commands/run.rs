//! `host-sim run`: one scene to its files.

use std::path::{Path, PathBuf};

use scene::{Rule, Scene, Texture};
use tactile::ModelBuf;

use crate::bench::AnyListener;
use crate::decisions::{self, Confusion, Decided};
use crate::listening::{self, Fault};
use crate::progress::{Progress, Verbosity};
use crate::run::{Happened, Run};
use crate::trace::TraceFile;
use crate::{Error, report};

/// Runs the scene in `path`; writes `out/trace.csv`, and `out/decisions.csv`
/// where the scene classifies. Returns the score of the decisions, where there
/// are any to score.
///
/// # Errors
/// [`Error::Input`] for a scene or model that is wrong, otherwise what writing brings.
pub fn run(path: &Path, out: &Path, verbosity: Verbosity) -> Result<Option<String>, Error> {
    let loaded = Loaded::new(path)?;
    let (listener, classes) = loaded.listener()?;
    let run = Run::new(&loaded.scene, listener)?;
    play(run, &loaded.scene, &classes, out, verbosity, || Ok(()))
}

/// A scene that has been checked, and the model that it names.
#[derive(Debug)]
pub struct Loaded {
    /// The scene.
    pub scene: Scene,
    path: PathBuf,
    model: Option<(PathBuf, ModelBuf)>,
}

impl Loaded {
    /// Reads and checks the scene in `path`; cautions go to standard error.
    ///
    /// # Errors
    /// [`Error::Input`] for a scene or model that is wrong.
    pub fn new(path: &Path) -> Result<Self, Error> {
        let scene = Scene::load(path)?;
        plan::check(&scene).map_err(|refused| Error::file(path, refused))?;
        if let Some(caution) = plan::cautions(&scene) {
            report::warn(Error::file(path, caution));
        }
        let folder = path.parent().unwrap_or(Path::new("."));
        let model = scene
            .model_path(folder)
            .map(|path| listening::load(&path))
            .transpose()?;
        Ok(Self {
            scene,
            path: path.to_owned(),
            model,
        })
    }

    /// The classifier and the names of its classes; none without one.
    ///
    /// # Errors
    /// [`Error::Input`] if scene and model do not fit each other.
    pub fn listener(&self) -> Result<(Option<AnyListener<'_>>, Vec<String>), Error> {
        let path = &self.path;
        let (Some(classifier), Some((model_path, model))) = (&self.scene.classifier, &self.model)
        else {
            return Ok((None, Vec::new()));
        };
        let model = model
            .model()
            .map_err(|error| Error::file(model_path, error))?;
        let key = match classifier.rule {
            Rule::Sequential { .. } => "threshold",
            Rule::Window { .. } => "window",
        };
        let listener = listening::classifier(&model, classifier.rule);
        let listener = listener.map_err(|fault| match fault {
            Fault::Model(fault) => Error::file(model_path, fault),
            Fault::Rule(fault) => Error::file(path, format!("classifier.{key}: {fault}")),
        })?;
        let classes = listening::names(&model);
        knows_a_texture(&self.scene, &classes).map_err(|fault| Error::file(path, fault))?;
        Ok((Some(listener), classes))
    }
}

/// Plays a scene to its end and its files, as [`run`] does. `after` each tick
/// the module's own troubles can be told.
///
/// # Errors
/// What writing brings, and what `after` says.
pub fn play(
    mut run: Run<'_>,
    scene: &Scene,
    classes: &[String],
    out: &Path,
    verbosity: Verbosity,
    mut after: impl FnMut() -> Result<(), Error>,
) -> Result<Option<String>, Error> {
    let mut trace = TraceFile::create(&out.join("trace.csv"))?;
    let mut decided: Vec<Decided> = Vec::new();
    let mut happened = Happened::default();
    let mut progress = Progress::new(verbosity, "simulating", run.ticks());
    for n in 0..run.ticks() {
        let row = *run.tick(&mut happened);
        after()?;
        trace.row(&row)?;
        for event in &happened.events {
            report::limits_and_faults(row.t_s, event);
        }
        decided.extend(run.decided(&happened, classes));
        if n.is_multiple_of(1024) {
            progress.set(n);
        }
    }
    drop(progress);

    if scene.classifier.is_some() {
        decisions::write(&out.join("decisions.csv"), &decided)?;
    }
    trace.finish()?;
    Ok(scene.classifier.as_ref().map(|_| {
        let confusion = Confusion::new(classes, &decided);
        report::Summary(&confusion, scene.tick_hz).to_string()
    }))
}

/// A model that knows none of the textures presented is another scene's.
fn knows_a_texture(scene: &Scene, classes: &[String]) -> Result<(), String> {
    let Some(textured) = &scene.plant.textured else {
        return Ok(());
    };
    let known = |texture: &Texture| classes.iter().any(|class| class == texture.name());
    if textured.textures.iter().any(known) {
        return Ok(());
    }
    let presented: Vec<_> = textured
        .textures
        .iter()
        .map(|texture| texture.name())
        .collect();
    Err(format!(
        "classifier.model: found the classes {}; the scene presents {}",
        classes.join(", "),
        presented.join(", ")
    ))
}
