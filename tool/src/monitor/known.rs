//! What the PC must know of a module to classify as it does.

use std::path::Path;

use host_sim::classifier::Classifier;
use host_sim::loaded::Loaded;
use host_sim::{Error, files};
use scene::Rule;

/// How sure a classifier must be where no scene says it.
const RULE: Rule = Rule::Sequential { threshold: 0.99 };

/// A classifier, and what it takes for a sample.
#[derive(Debug, Clone)]
pub(crate) struct Known {
    pub(crate) classifier: Classifier,
    pub(crate) contact_min: Option<f64>,
    /// For how long a sensor's words may repeat, s.
    pub(crate) frozen_s: f64,
}

impl Known {
    /// That of a scene, with another model or its own; none without either.
    pub(crate) fn of(scene: Option<&Path>, model: Option<&Path>) -> Result<Option<Self>, Error> {
        let loaded = scene.map(Loaded::new).transpose()?;
        let said = loaded.as_ref().map(|of| &of.scene);
        let said = said.filter(|scene| scene.classifier.is_some());
        let classifier = match (model, &loaded) {
            (Some(path), _) => {
                let (_, model) = files::load_model(path)?;
                let classifier = match said {
                    Some(scene) => Classifier::of_scene(model, scene),
                    None => Classifier::new(model, RULE),
                };
                Some(classifier.map_err(|fault| Error::file(path, fault))?)
            }
            (None, Some(loaded)) => loaded.classifier()?,
            (None, None) => None,
        };
        let Some(classifier) = classifier else {
            return Ok(None);
        };
        let gate = classifier.touch_rule().map(|touch| touch.gate);
        let contact_min = match &loaded {
            Some(loaded) => config::contact_min(&loaded.scene, gate)
                .map_err(|fault| Error::Input(fault.to_string()))?,
            None => gate.map(f64::from),
        };
        let frozen_s = loaded.map_or(f64::INFINITY, |loaded| loaded.scene.sensor.frozen_s);
        Ok(Some(Self {
            classifier,
            contact_min,
            frozen_s,
        }))
    }
}
