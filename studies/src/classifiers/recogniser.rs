//! One way to ask any classifier, for experiments on a PC: samples in, the
//! name of a class out, whatever the method.
//!
//! # Glossary
//!
//! - **sample**: one real number a channel, in the units of training.
//! - **segment**: the samples of one trial, whisk or window.
//! - **outcome**: the class that a recogniser names, and after how many samples.
//!
//! [`Bayes`] wraps naive Bayes under any rule.

use anyhow::Result;
use tactile::{Decision, DecisionRule, Model, NaiveBayes, Posteriors, Quantiser, SetupError};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Outcome {
    /// The class, from zero, in the order of training.
    pub(crate) class: usize,
    /// Samples that it took since the last outcome (or the start).
    pub(crate) samples: u32,
}

/// Anything that names a class from a stream of samples.
pub(crate) trait Recogniser {
    /// Takes one sample of all channels; gives an outcome where one falls.
    /// A sample of another number of channels is not taken.
    fn push(&mut self, sample: &[f64]) -> Option<Outcome>;

    /// The end of the segment: an outcome of those that wait for it. Then as new.
    fn finish(&mut self) -> Option<Outcome>;
}

/// Samples of `channels` values, one after another. Starts and ends as new.
pub(crate) fn outcomes(
    recogniser: &mut impl Recogniser,
    segment: &[f64],
    channels: usize,
) -> Vec<Outcome> {
    let mut found: Vec<Outcome> = segment
        .chunks_exact(channels)
        .filter_map(|sample| recogniser.push(sample))
        .collect();
    found.extend(recogniser.finish());
    found
}

/// Naive Bayes by the code of a board: samples become codes by the quantisers
/// of the model.
pub(crate) struct Bayes<'m, R: DecisionRule> {
    classifier: NaiveBayes<R, &'m [u32]>,
    quantisers: Vec<Quantiser>,
    codes: Vec<i32>,
}

impl<'m, R: DecisionRule> Bayes<'m, R> {
    /// Fails where the rule's settings do not fit the model.
    pub(crate) fn new(model: Model<&'m [u32]>, settings: R::Settings) -> Result<Self, SetupError> {
        let quantisers: Vec<_> = (0..model.channels())
            .filter_map(|channel| model.quantiser(channel))
            .collect();
        Ok(Self {
            classifier: NaiveBayes::new(model, settings)?,
            codes: Vec::with_capacity(quantisers.len()),
            quantisers,
        })
    }

    pub(crate) fn posteriors(&self) -> Posteriors {
        self.classifier.posteriors()
    }
}

impl From<Decision> for Outcome {
    fn from(decision: Decision) -> Self {
        Self {
            class: decision.leader(),
            samples: decision.samples(),
        }
    }
}

impl<R: DecisionRule> Recogniser for Bayes<'_, R> {
    fn push(&mut self, sample: &[f64]) -> Option<Outcome> {
        if sample.len() != self.quantisers.len() {
            return None;
        }
        self.codes.clear();
        let codes = self.quantisers.iter().zip(sample);
        self.codes.extend(codes.map(|(q, &x)| q.code_from_f64(x)));
        let pushed = self.classifier.push(&self.codes);
        pushed.ok().flatten().map(Outcome::from)
    }

    fn finish(&mut self) -> Option<Outcome> {
        self.classifier.finish().map(Outcome::from)
    }
}
