//! A scene that has been checked together with the model that it names.

use std::path::{Path, PathBuf};

use config::Mismatch;
use scene::{Override, Places, Rule, Scene, Texture};
use tactile::ModelBuf;

use crate::classifier::{Classifier, Fault};
use crate::{Error, world};

/// A scene that has been checked, and the model that it names.
#[derive(Debug, Clone)]
pub struct Loaded {
    /// The scene.
    pub scene: Scene,
    path: PathBuf,
    places: Places,
    model: Option<(PathBuf, ModelBuf)>,
}

impl Loaded {
    /// Checks a scene from its text, which messages call `file`. Where it names a model,
    /// `model` gives the bytes of what stands under that name.
    ///
    /// # Errors
    /// [`Error::Input`] for a scene or model that is wrong.
    pub fn from_text(
        file: &str,
        text: &str,
        set: &[Override],
        model: impl FnOnce(&Path) -> Result<Vec<u8>, String>,
    ) -> Result<Self, Error> {
        let read = Scene::from_str_with(file, text, set)?;
        Self::of(Path::new(file), read, |scene| {
            let name = Path::new(scene.classifier.as_ref()?.model.as_ref()?);
            let bytes = model(name).map_err(|fault| Error::file(name, fault));
            Some(bytes.and_then(|bytes| model_of(name, &bytes)))
        })
    }

    /// `model` gives the model that the scene names, if any, and what messages call it.
    pub(crate) fn of(
        path: &Path,
        (scene, places): (Scene, Places),
        model: impl FnOnce(&Scene) -> Option<Result<(PathBuf, ModelBuf), Error>>,
    ) -> Result<Self, Error> {
        config::check(&scene).map_err(|refused| Error::file(path, refused))?;
        let model = model(&scene)
            .transpose()
            .map_err(|fault| Error::Input(places.fault("classifier.model", fault)))?;
        Ok(Self {
            scene,
            path: path.to_owned(),
            places,
            model,
        })
    }

    /// What its user should know of the scene, though nothing is wrong with it.
    pub fn caution(&self) -> Option<String> {
        let of_module = config::cautions(&self.scene).map(|caution| caution.to_string());
        let all = of_module.into_iter().chain(world::caution(&self.scene));
        let all: Vec<String> = all
            .map(|caution| Error::file(&self.path, caution).to_string())
            .chain(self.places.idle())
            .collect();
        (!all.is_empty()).then(|| all.join("\n"))
    }

    /// The same with a model that was read from a place that messages call `path`.
    #[must_use]
    pub fn with_deployed(mut self, path: &Path, model: Option<ModelBuf>) -> Self {
        self.model = model.map(|model| (path.to_owned(), model));
        self
    }

    /// Whether a model can be deployed to its module.
    ///
    /// # Errors
    /// [`Error::Input`] says why not.
    pub fn takes_model(&self) -> Result<(), Error> {
        if self.scene.awaits_model() {
            return Ok(());
        }
        Err(Error::Input(if self.scene.classifier.is_some() {
            self.places.fault(
                "classifier.model",
                "found, so the scene brings its model; for one that is deployed apart take this \
                 line out",
            )
        } else {
            let path = self.path.display();
            format!("{path}: it has no [classifier], and so no use for a model")
        }))
    }

    /// The model that it decides by, if it has one.
    pub fn model(&self) -> Option<&ModelBuf> {
        self.model.as_ref().map(|(_, model)| model)
    }

    /// What its user should know of a classifier that has no model yet.
    pub fn without_model(&self) -> Option<String> {
        (self.scene.awaits_model() && self.model.is_none()).then(|| {
            let fault = "names no model, and none is given: nothing is decided";
            self.places.fault("classifier", fault)
        })
    }

    /// The scene's classifier; none without one.
    ///
    /// # Errors
    /// [`Error::Input`] if scene and model do not fit each other.
    pub fn classifier(&self) -> Result<Option<Classifier>, Error> {
        let refused = |key: &str, fault: String| Error::Input(self.places.fault(key, fault));
        let (Some(classifier), Some((model_path, model))) = (&self.scene.classifier, &self.model)
        else {
            return Ok(None);
        };
        let key = match classifier.rule {
            Rule::Sequential { .. } => "classifier.threshold",
            Rule::Costs { .. } => "classifier.cost_error",
            Rule::Window { .. } => "classifier.window",
        };
        config::classes(&self.scene, model).map_err(|fault| match fault {
            Mismatch::Classes {
                key,
                found,
                allowed,
            } => refused(
                &format!("classifier.{key}"),
                format!("found {found}; allowed: {allowed}"),
            ),
            fault => Error::Input(fault.to_string()),
        })?;
        let classifier = Classifier::of_scene(model.clone(), &self.scene);
        let classifier = classifier.map_err(|fault| match fault {
            Fault::Model(fault) => {
                let fault = Error::file(model_path, fault).to_string();
                refused("classifier.model", fault)
            }
            Fault::Rule(fault) => refused(key, fault),
        })?;
        let gate = classifier.touch_rule().map(|touch| touch.gate);
        let unsuited =
            |key: &str, fault: Mismatch| Error::Input(format!("{}: {fault}", self.places.of(key)));
        config::contact_min(&self.scene, gate)
            .map_err(|fault| unsuited("classifier.contact_min", fault))?;
        config::suits(&self.scene, model).map_err(|fault| unsuited("classifier.model", fault))?;
        knows_a_texture(&self.scene, classifier.classes())
            .map_err(|fault| refused("classifier.model", fault))?;
        Ok(Some(classifier))
    }

    /// The names of the classes that the scene decides among.
    ///
    /// # Errors
    /// As [`Loaded::classifier`].
    pub fn classes(&self) -> Result<Vec<String>, Error> {
        let classifier = self.classifier()?;
        let classes = classifier.as_ref().map(Classifier::classes);
        Ok(classes.unwrap_or_default().to_vec())
    }
}

pub(crate) fn model_of(path: &Path, bytes: &[u8]) -> Result<(PathBuf, ModelBuf), Error> {
    let model = ModelBuf::from_bytes(bytes).map_err(|error| Error::file(path, error))?;
    Ok((path.to_owned(), model))
}

/// A model with none of the presented textures belongs to another scene.
fn knows_a_texture(scene: &Scene, classes: &[String]) -> Result<(), String> {
    let Some(textured) = &scene.plant.textured else {
        return Ok(());
    };
    let known = |texture: &Texture| classes.iter().any(|class| class == texture.name());
    if textured.textures.iter().any(known) {
        return Ok(());
    }
    let presented = textured.textures.iter().map(|texture| texture.name());
    let presented: Vec<_> = presented.collect();
    Err(format!(
        "found the classes {}; the scene presents {}",
        classes.join(", "),
        presented.join(", ")
    ))
}
