//! The classifiers of the firmware with the number of classes known only now.

use std::fmt::Display;

use firmware::{CodeClassifier, SampleClassifier};
use scene::Rule;
use tactile::{Decision, Model, ModelBuf, Sequential, Threshold, Window};

/// The very classifier that a board runs, with its model.
pub struct Classifier {
    listener: Box<dyn SampleClassifier + Send>,
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
        let model: &'static ModelBuf = Box::leak(Box::new(model));
        let model = model.model().map_err(of_model)?;
        Ok(Self {
            listener: classifier(&model, rule)?,
            classes: names(&model),
        })
    }

    /// The names of its classes.
    pub fn classes(&self) -> &[String] {
        &self.classes
    }
}

/// What stands between the first whisker and its classifier, if there is one:
/// it keeps the last sample, for recordings.
pub struct Tap {
    /// The codes x and y of the last tick, if the classifier was given any.
    pub(crate) sample: Option<[u16; 2]>,
    classifier: Option<Classifier>,
}

impl Tap {
    pub(crate) const fn new(classifier: Option<Classifier>) -> Self {
        Self {
            sample: None,
            classifier,
        }
    }

    /// As before the first tick.
    pub(crate) fn restart(&mut self) {
        self.sample = None;
        self.reset();
    }
}

impl SampleClassifier for Tap {
    fn push(&mut self, codes: [u16; 2]) -> Option<Decision> {
        self.sample = Some(codes);
        self.classifier.as_mut()?.listener.push(codes)
    }

    fn reset(&mut self) {
        if let Some(classifier) = &mut self.classifier {
            classifier.listener.reset();
        }
    }
}

/// The class names of a model.
pub fn names(model: &Model<'_>) -> Vec<String> {
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

type AnyListener = Box<dyn SampleClassifier + Send>;

fn classifier(model: &Model<'static>, rule: Rule) -> Result<AnyListener, Fault> {
    if model.channels() != 2 {
        let fault = format!("the model has {} channels, not x and y", model.channels());
        return Err(Fault::Model(fault));
    }
    macro_rules! classes {
        ($($k:literal)*) => {
            match model.classes() {
                $($k => streaming::<$k>(model, rule),)*
                count => Err(Fault::Model(format!("no classifier of {count} classes"))),
            }
        };
    }
    classes!(2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31 32)
}

fn streaming<const K: usize>(model: &Model<'static>, rule: Rule) -> Result<AnyListener, Fault>
where
    tactile::Classes<K>: tactile::Supported,
{
    match rule {
        Rule::Sequential { threshold } => {
            let threshold = Threshold::new(threshold).map_err(of_rule)?;
            let classifier = Sequential::<2, K>::new(model, threshold).map_err(of_rule)?;
            Ok(Box::new(
                CodeClassifier::new(model, classifier).map_err(of_model)?,
            ))
        }
        Rule::Window { samples } => {
            let classifier = Window::<2, K>::new(model, samples).map_err(of_rule)?;
            Ok(Box::new(
                CodeClassifier::new(model, classifier).map_err(of_model)?,
            ))
        }
    }
}

fn of_rule(error: impl Display) -> Fault {
    Fault::Rule(error.to_string())
}

fn of_model(error: impl Display) -> Fault {
    Fault::Model(error.to_string())
}
