//! The classifier of the firmware with its rule known only now.

use std::fmt::Display;

use firmware::{CodeClassifier, Sample, SampleClassifier};
use scene::Rule;
use tactile::{
    AnyRule, AnyRuleSettings, Decision, Model, ModelBuf, NaiveBayes, Posteriors, Quantiser,
    Threshold, TouchRule,
};

/// Contact from which a sample counts, unless scene or model say otherwise.
pub const GATE: f64 = 0.05;

/// The classifier that a board runs, with its model.
#[derive(Debug, Clone)]
pub struct Classifier {
    codes: CodeClassifier<AnyRule, Box<[u32]>>,
    classes: Vec<String>,
}

impl Classifier {
    /// A classifier by a rule.
    ///
    /// # Errors
    /// [`Fault::Model`] for other than two channels or a model that was not
    /// trained on sensor codes, [`Fault::Rule`] for a window that is no multiple
    /// of the model's block or a threshold too near to 1.
    pub fn new(model: ModelBuf, rule: Rule) -> Result<Self, Fault> {
        quantisers(&model)?;
        let classes = names(&model);
        let bayes = bayes(model, rule)?;
        Ok(Self {
            codes: CodeClassifier::new(bayes).map_err(of_model)?,
            classes,
        })
    }

    /// The names of its classes.
    pub fn classes(&self) -> &[String] {
        &self.classes
    }

    /// What a touch means to its model.
    pub fn touch_rule(&self) -> Option<TouchRule> {
        self.codes.bayes().model().touch_rule()
    }

    /// Posterior of each class after the last full block.
    pub fn posteriors(&self) -> Posteriors {
        self.codes.bayes().posteriors()
    }
}

impl SampleClassifier for Classifier {
    fn push(&mut self, sample: Sample) -> Option<Decision> {
        self.codes.push(sample)
    }

    fn knows_touches(&self) -> bool {
        self.codes.knows_touches()
    }

    fn interrupt(&mut self) {
        self.codes.interrupt();
    }

    fn reset(&mut self) {
        self.codes.reset();
    }
}

/// What stands between the first whisker and its classifier, if there is one:
/// it keeps the last sample, for recordings.
pub struct Tap {
    /// The sample of the last tick, if there was one.
    pub(crate) sample: Option<Sample>,
    classifier: Option<Classifier>,
}

impl Tap {
    pub(crate) const fn new(classifier: Option<Classifier>) -> Self {
        Self {
            sample: None,
            classifier,
        }
    }

    /// What a touch means to the classifier's model, if there is one.
    pub(crate) fn touch_rule(&self) -> Option<TouchRule> {
        self.classifier.as_ref()?.touch_rule()
    }

    /// Whether there is none.
    pub(crate) const fn is_recording(&self) -> bool {
        self.classifier.is_none()
    }

    /// Posteriors of the classifier, if there is one.
    pub(crate) fn posteriors(&self) -> Option<Posteriors> {
        self.classifier.as_ref().map(Classifier::posteriors)
    }
}

impl SampleClassifier for Tap {
    fn push(&mut self, sample: Sample) -> Option<Decision> {
        self.sample = Some(sample);
        self.classifier.as_mut()?.push(sample)
    }

    fn knows_touches(&self) -> bool {
        // A recording has them for whatever model is made of it.
        let classifier = self.classifier.as_ref();
        classifier.is_none_or(SampleClassifier::knows_touches)
    }

    fn interrupt(&mut self) {
        if let Some(classifier) = &mut self.classifier {
            classifier.interrupt();
        }
    }

    fn reset(&mut self) {
        self.sample = None;
        if let Some(classifier) = &mut self.classifier {
            classifier.reset();
        }
    }
}

/// How the two channels of a whisker are quantised.
pub(crate) fn quantisers(model: &ModelBuf) -> Result<[Quantiser; 2], Fault> {
    match (model.quantiser(0), model.quantiser(1), model.channels()) {
        (Some(x), Some(y), 2) => Ok([x, y]),
        (_, _, count) => Err(Fault::Model(format!(
            "the model has {count} channels, not x and y"
        ))),
    }
}

/// A model under a rule.
pub(crate) fn bayes(model: ModelBuf, rule: Rule) -> Result<NaiveBayes<AnyRule, Box<[u32]>>, Fault> {
    let settings = match rule {
        Rule::Sequential { threshold } => {
            AnyRuleSettings::Sequential(Threshold::new(threshold).map_err(of_rule)?)
        }
        Rule::Window { samples } => AnyRuleSettings::Window(samples),
    };
    NaiveBayes::new(model, settings).map_err(of_rule)
}

/// The class names of a model.
pub fn names<W: tactile::Words>(model: &Model<W>) -> Vec<String> {
    model.names().map(str::to_owned).collect()
}

/// What keeps a classifier from being made.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Fault {
    /// The model is not one for the two channels of a whisker.
    #[error("{0}")]
    Model(String),
    /// The rule asks for what no model, or not this one, can do.
    #[error("{0}")]
    Rule(String),
}

fn of_rule(error: impl Display) -> Fault {
    Fault::Rule(error.to_string())
}

fn of_model(error: impl Display) -> Fault {
    Fault::Model(error.to_string())
}
