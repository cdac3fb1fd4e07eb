//! What the module decides, as the scene names it: its type, its constants, its
//! start, and the names of the classes.

use core::marker::PhantomData;

use firmware::{Classifying, ClassifyingConfig, CodeClassifier, Perception};
use tactile::{Decision, Model, NaiveBayes, SequentialRule, Threshold, WindowRule};

use super::log;
use super::scene::Number;

/// Constants of a [`Decides`].
pub(crate) type Config<D> = <<D as Decides>::Perception as Perception<Number, 1, 1>>::Config;

/// How a module with one whisker decides what it touches.
pub(crate) trait Decides {
    /// Its type in the library.
    type Perception: Perception<Number, 1, 1>;
    /// What the classes are called.
    type Names: Names;

    /// Its constants.
    const CONFIG: Config<Self>;

    /// Perception before its first sample; `None` if the flash is damaged: the
    /// build has checked everything else.
    fn start() -> Option<(Self::Perception, Self::Names)>;
}

/// What classes are called.
pub(crate) trait Names: Send + 'static {
    /// A line for a decision.
    fn tell(&self, decided: Decision);
}

/// It does not.
pub(crate) struct Nothing;

impl Decides for Nothing {
    type Perception = ();
    type Names = ();

    const CONFIG: () = ();

    fn start() -> Option<((), ())> {
        Some(((), ()))
    }
}

impl Names for () {
    // What cannot happen has no words.
    fn tell(&self, _: Decision) {}
}

/// The model in flash knows.
impl Names for Model {
    fn tell(&self, decided: Decision) {
        log::decision(self.name(decided.class()).unwrap_or("?"), decided);
    }
}

/// What a scene with a classifier says.
pub(crate) trait Classifies {
    /// Least contact during which samples count.
    const CONTACT_MIN: Option<Number>;

    /// The model in flash.
    fn model() -> &'static [u8];
}

/// The posterior at which a scene's decisions fall.
pub(crate) trait AtThreshold: Classifies {
    /// The posterior.
    const THRESHOLD: Threshold;
}

/// The samples that a scene's decisions take.
pub(crate) trait ByWindow: Classifies {
    /// Samples a decision, a multiple of the model's block.
    const SAMPLES: u32;
}

/// One whisker, and a sequential classifier.
pub(crate) struct Sequential<S>(PhantomData<S>);

impl<S: AtThreshold> Decides for Sequential<S> {
    type Perception = Classifying<CodeClassifier<SequentialRule>>;
    type Names = Model;

    const CONFIG: ClassifyingConfig<Number> = ClassifyingConfig {
        contact_min: S::CONTACT_MIN,
    };

    fn start() -> Option<(Self::Perception, Self::Names)> {
        let model = Model::parse(S::model()).ok()?;
        let classifier = NaiveBayes::new(model, S::THRESHOLD).ok()?;
        let stream = CodeClassifier::new(classifier).ok()?;
        Some((Classifying::new(stream), model))
    }
}

/// One whisker, and a classifier by windows.
pub(crate) struct Window<S>(PhantomData<S>);

impl<S: ByWindow> Decides for Window<S> {
    type Perception = Classifying<CodeClassifier<WindowRule>>;
    type Names = Model;

    const CONFIG: ClassifyingConfig<Number> = ClassifyingConfig {
        contact_min: S::CONTACT_MIN,
    };

    fn start() -> Option<(Self::Perception, Self::Names)> {
        let model = Model::parse(S::model()).ok()?;
        let classifier = NaiveBayes::new(model, S::SAMPLES).ok()?;
        let stream = CodeClassifier::new(classifier).ok()?;
        Some((Classifying::new(stream), model))
    }
}
