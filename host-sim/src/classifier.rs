//! The classifier of the firmware, with its model in memory of its own.

use std::fmt::Display;

use config::rule_settings;
use firmware::boards::BoardFacts;
use firmware::{CodeClassifier, ModelLimits, ModelState, Refusal, Sample, SampleClassifier};
use scene::{Deciding, Rule, Scene};
use tactile::{
    AnyRule, ClassList, ClassSetting, ClassSettings, Decision, Felt, MAX_STREAMS, Model, ModelBuf,
    NaiveBayes, Pose, Posteriors, Quantiser, RuleSettings, Threshold, TouchRule,
};

use crate::Error;

/// Contact from which a sample counts, unless scene or model say otherwise.
pub const GATE: f64 = 0.05;

type Words = Box<[u32]>;

/// A classifier of codes, with its model beside it.
pub type Codes = CodeClassifier<Words>;

/// The classifier that a board runs, with its model.
#[derive(Debug, Clone)]
pub struct Classifier {
    codes: Box<Codes>,
    deciding: Deciding,
    classes: Vec<String>,
    settings: ClassList,
}

impl Classifier {
    /// A classifier of the first whisker, by a rule.
    ///
    /// # Errors
    /// [`Fault::Model`] for other than two channels or a model that was not
    /// trained on sensor codes, [`Fault::Rule`] for a window that is no multiple
    /// of the model's block or a threshold too near to 1.
    pub fn new(model: ModelBuf, rule: Rule) -> Result<Self, Fault> {
        Self::of(model, rule, Deciding::First)
    }

    /// A classifier of some whiskers, by a rule.
    ///
    /// # Errors
    /// As [`Classifier::new`], and [`Fault::Rule`] for windows together.
    pub fn of(model: ModelBuf, rule: Rule, deciding: Deciding) -> Result<Self, Fault> {
        Self::weighed(model, settings(rule)?, deciding, ClassList::new())
    }

    /// The classifier of a scene that has one, by this model, with the scene's priors and
    /// thresholds of classes.
    ///
    /// # Errors
    /// As [`Classifier::of`], and [`Fault::Rule`] for classes that the model does not have.
    pub fn of_scene(model: ModelBuf, scene: &Scene) -> Result<Self, Fault> {
        let Some(classifier) = &scene.classifier else {
            return Err(Fault::Rule("the scene has no classifier".to_owned()));
        };
        let classes = config::classes(scene, &model).map_err(of_rule)?;
        let rule = rule_settings(classifier, &classes).map_err(of_rule)?;
        Self::weighed(model, rule, classifier.whiskers, classes)
    }

    fn weighed(
        model: ModelBuf,
        rule: RuleSettings,
        deciding: Deciding,
        settings: ClassList,
    ) -> Result<Self, Fault> {
        // A model of more channels has two for each whisker, which the scene is held against.
        quantisers(&model)?;
        let classes = names(&model);
        // Whiskers that a module does not have say nothing.
        let classifier = tactile::StreamClassifier::new(model, rule, deciding, MAX_STREAMS);
        let mut classifier = classifier.map_err(of_rule)?;
        classifier.set_classes(&ClassSettings::of(&settings));
        let codes = CodeClassifier::new(classifier).map_err(of_model)?;
        Ok(Self {
            codes: Box::new(codes),
            deciding,
            classes,
            settings,
        })
    }

    /// Which whiskers decide, and by what.
    pub const fn deciding(&self) -> Deciding {
        self.deciding
    }

    /// The priors and thresholds of its classes, if a scene has any.
    pub const fn settings(&self) -> &ClassList {
        &self.settings
    }

    /// By what samples of all whiskers are classified.
    pub fn codes_mut(&mut self) -> &mut Codes {
        &mut self.codes
    }

    /// The same, alone.
    pub fn into_codes(self) -> Codes {
        *self.codes
    }

    /// Channels of its model: two of all whiskers, or two of each.
    pub(crate) fn channels(&self) -> usize {
        self.codes.model().map_or(0, Model::channels)
    }

    pub(crate) fn has_opinion(&self) -> bool {
        self.codes.model().is_some_and(Model::has_opinion)
    }

    /// The names of its classes.
    pub fn classes(&self) -> &[String] {
        &self.classes
    }

    /// What a touch means to its model.
    pub fn touch_rule(&self) -> Option<TouchRule> {
        self.codes.model()?.touch_rule()
    }

    /// Which model it decides by.
    pub fn model(&self) -> ModelState {
        self.codes.state()
    }

    /// Posterior of each class after the last full block: of the first whisker, or of all together.
    pub fn posteriors(&self) -> Posteriors {
        posteriors(&self.codes, 0)
    }
}

/// What it makes of the classes by now: posteriors of a whisker, counted from 0, left side first, or
/// of all together; none where nothing is classified.
pub fn posteriors(codes: &Codes, whisker: usize) -> Posteriors {
    let classifier = codes.classifier();
    classifier.map_or_else(Posteriors::default, |one| one.posteriors(whisker))
}

/// What stands between the whiskers that are heard and their classifier, if there is one:
/// it keeps the last samples, for recordings.
pub struct Tap {
    /// The samples of the last tick, of each whisker that is heard, if there was one.
    pub(crate) samples: Vec<Option<Sample>>,
    pub(crate) classifier: Option<Classifier>,
}

impl Tap {
    pub(crate) fn new(classifier: Option<Classifier>, heard: usize) -> Self {
        Self {
            samples: vec![None; heard],
            classifier,
        }
    }

    fn codes(&self) -> Option<&Codes> {
        Some(&*self.classifier.as_ref()?.codes)
    }

    fn codes_mut(&mut self) -> Option<&mut Codes> {
        Some(&mut *self.classifier.as_mut()?.codes)
    }
}

impl SampleClassifier for Tap {
    fn hears(&self, whisker: usize) -> bool {
        whisker < self.samples.len()
    }

    fn push(&mut self, whisker: usize, sample: Sample) -> Option<Decision> {
        *self.samples.get_mut(whisker)? = Some(sample);
        self.codes_mut()?.push(whisker, sample)
    }

    fn pose(&self, whisker: usize, class: usize) -> Option<Pose> {
        self.codes()?.pose(whisker, class)
    }

    fn knows_touches(&self) -> bool {
        // A recording has them for whatever model is made of it.
        self.codes().is_none_or(SampleClassifier::knows_touches)
    }

    fn interrupt(&mut self, whisker: usize) {
        if let Some(codes) = self.codes_mut() {
            codes.interrupt(whisker);
        }
    }

    fn reset(&mut self) {
        self.samples.fill(None);
        if let Some(codes) = self.codes_mut() {
            codes.reset();
        }
    }

    fn classes(&self) -> usize {
        self.codes().map_or(0, SampleClassifier::classes)
    }

    fn evidence(&self) -> Option<Felt> {
        self.codes()?.evidence()
    }

    fn hear(&mut self, board: usize, felt: Option<&Felt>) -> Option<Decision> {
        self.codes_mut()?.hear(board, felt)
    }

    fn set_led(&mut self, is_led: bool) {
        if let Some(codes) = self.codes_mut() {
            codes.set_led(is_led);
        }
    }

    fn forget(&mut self) {
        if let Some(codes) = self.codes_mut() {
            codes.forget();
        }
    }

    fn set_rule(&mut self, settings: &RuleSettings, classes: &[ClassSetting]) {
        if let Some(codes) = self.codes_mut() {
            codes.set_rule(settings, classes);
        }
    }
}

/// How the two channels of each whisker that has tables of its own are quantised, or of all.
pub(crate) fn quantisers(model: &ModelBuf) -> Result<Vec<[Quantiser; 2]>, Fault> {
    let of_whisker = |first| Some([model.quantiser(first)?, model.quantiser(first + 1)?]);
    let all = (0..model.channels()).step_by(2).map(of_whisker);
    all.collect::<Option<_>>().ok_or_else(|| {
        let count = model.channels();
        Fault::Model(format!("the model has {count} channels, not x and y"))
    })
}

pub(crate) fn bayes(model: ModelBuf, rule: Rule) -> Result<NaiveBayes<AnyRule, Words>, Fault> {
    NaiveBayes::new(model, settings(rule)?).map_err(of_rule)
}

/// The model at the beginning of a board's flash for one, for the classifier of `scene`, or why
/// the board refuses it.
///
/// # Errors
/// [`Error::Input`] for a rule that no model can do.
pub fn deployed(
    flash: &[u8],
    scene: &Scene,
    board: &BoardFacts,
) -> Result<Result<ModelBuf, Refusal>, Error> {
    let Some(classifier) = &scene.classifier else {
        return Ok(Err(Refusal::Absent));
    };
    let limits = ModelLimits {
        classes: board.max_classes,
        poses: board.poses_of_each(classifier.whiskers.heard(scene.whiskers())),
        contact_min: classifier.contact_min.map(|least| least as f32),
        whisked: config::whisked(scene),
        tick_hz: scene.tick_hz,
    };
    let (words, _) = flash.as_chunks();
    let words = words.iter().map(|word| u32::from_le_bytes(*word));
    let words: Vec<u32> = words.collect();
    // Thresholds by costs keep no model from being taken.
    let rule = match classifier.rule {
        Rule::Costs { .. } => settings(Rule::Sequential { threshold: 0.5 }),
        rule => settings(rule),
    };
    let rule = rule.map_err(|fault| Error::Input(fault.to_string()))?;
    let rule = (rule, classifier.whiskers);
    let bytes = bytemuck::cast_slice(&words);
    let found = CodeClassifier::at_start(bytes, limits, rule, scene.whiskers());
    Ok(match (found.state(), found.model()) {
        (ModelState::Refused(refusal), _) => Err(refusal),
        (_, Some(model)) => {
            let copied = ModelBuf::from_bytes(model.as_bytes());
            copied.map_err(|_| Refusal::Content)
        }
        (_, None) => Err(Refusal::Absent),
    })
}

pub(crate) fn settings(rule: Rule) -> Result<RuleSettings, Fault> {
    Ok(match rule {
        Rule::Sequential { threshold } => {
            RuleSettings::Sequential(Threshold::new(threshold).map_err(of_rule)?)
        }
        Rule::Window { samples } => RuleSettings::Window(samples),
        // Their thresholds are of a scene's model.
        Rule::Costs { .. } => return Err(Fault::Rule("costs are a scene's".to_owned())),
    })
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

pub(crate) fn of_model(error: impl Display) -> Fault {
    Fault::Model(error.to_string())
}
