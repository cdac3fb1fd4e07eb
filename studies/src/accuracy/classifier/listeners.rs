//! The yardstick, the product and the variants behind one interface, block by
//! block.

use scene::Rule;
use tactile::reference::{ReferenceRule, ReferenceStream};
use tactile::{Model, Threshold, dynamic};

use super::data::Recording;
use super::evidence::{Evidence, Sums};
use super::model::Variant;
use host_sim::Error;

/// A decision that fell: which class, from how many samples.
pub(super) type Fell = Option<(usize, u32)>;

/// Somebody who hears a recording, under a rule or (open loop) without.
pub(super) trait Listener {
    /// Hears a full block of a stream. After a decision it starts again.
    fn hear(&mut self, stream: usize, block: usize) -> Fell;

    /// Starts again.
    fn forget(&mut self);

    /// Posterior of each class.
    fn posteriors(&self) -> Vec<f64>;
}

/// Double precision.
pub(super) struct Yardstick<'r> {
    recording: &'r Recording,
    stream: ReferenceStream<'r>,
}

impl<'r> Yardstick<'r> {
    pub(super) fn new(recording: &'r Recording, rule: Option<Rule>) -> Self {
        let rule = match rule {
            Some(Rule::Sequential { threshold }) => ReferenceRule::Sequential(threshold),
            Some(Rule::Window { samples }) => ReferenceRule::Window(samples.into()),
            // A window that no recording fills.
            None => ReferenceRule::Window(u64::MAX),
        };
        Self {
            recording,
            stream: recording.reference.stream(rule),
        }
    }
}

impl Listener for Yardstick<'_> {
    fn hear(&mut self, stream: usize, block: usize) -> Fell {
        let samples = self.recording.block(stream, block, |heard| &heard.samples);
        let mut fell = None;
        for sample in samples {
            fell = self.stream.push(sample).or(fell);
        }
        fell.map(|decision| (decision.class, decision.samples as u32))
    }

    fn forget(&mut self) {
        self.stream.finish();
    }

    fn posteriors(&self) -> Vec<f64> {
        self.stream.posteriors()
    }
}

/// What the module runs.
pub(super) struct Product<'r> {
    recording: &'r Recording,
    classifier: Box<dyn dynamic::Classifier + 'r>,
}

impl<'r> Product<'r> {
    /// Of the recording's model. Open loop is the sequential rule at the
    /// largest threshold that there is, 1 − 1e-12.
    ///
    /// # Errors
    /// [`Error::Work`] if the rule does not fit the model.
    pub(super) fn new(
        recording: &'r Recording,
        model: &Model<'r>,
        rule: Option<Rule>,
    ) -> Result<Self, Error> {
        let highest = Rule::Sequential {
            threshold: 1.0 - 1e-12,
        };
        let classifier = match rule.unwrap_or(highest) {
            Rule::Sequential { threshold } => Threshold::new(threshold)
                .and_then(|threshold| dynamic::sequential(model, threshold)),
            Rule::Window { samples } => dynamic::window(model, samples),
        };
        Ok(Self {
            recording,
            classifier: classifier.map_err(|error| Error::Work(error.to_string()))?,
        })
    }
}

impl Listener for Product<'_> {
    fn hear(&mut self, stream: usize, block: usize) -> Fell {
        let mut fell = None;
        for codes in self.recording.block(stream, block, |heard| &heard.codes) {
            // Two codes for two channels: there is no error.
            let pushed = self.classifier.push(codes).ok().flatten();
            fell = pushed.or(fell);
        }
        fell.map(|decision| (decision.class(), decision.samples()))
    }

    fn forget(&mut self) {
        self.classifier.reset();
    }

    fn posteriors(&self) -> Vec<f64> {
        self.classifier.posteriors()
    }
}

/// A variant.
pub(super) struct Integers<'s> {
    sums: &'s Sums,
    rule: Option<Rule>,
    evidence: Evidence,
}

impl<'s> Integers<'s> {
    /// `sums` are those of the variant's entries.
    pub(super) fn new(
        recording: &Recording,
        sums: &'s Sums,
        variant: Variant,
        rule: Option<Rule>,
    ) -> Self {
        Self {
            sums,
            rule,
            evidence: Evidence::new(variant, recording.options.block, recording.classes),
        }
    }
}

impl Listener for Integers<'_> {
    fn hear(&mut self, stream: usize, block: usize) -> Fell {
        self.evidence.add(self.sums.of(stream, block));
        if !self.evidence.decides(self.rule?) {
            return None;
        }
        let fell = (self.evidence.leader(), self.evidence.samples());
        self.evidence.forget();
        Some(fell)
    }

    fn forget(&mut self) {
        self.evidence.forget();
    }

    fn posteriors(&self) -> Vec<f64> {
        self.evidence.posteriors()
    }
}
