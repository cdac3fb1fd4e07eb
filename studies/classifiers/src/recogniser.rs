//! One way to ask any classifier, for experiments on a PC: samples in, the
//! name of a class out, whatever the method.
//!
//! # Glossary
//!
//! - **sample**: one real number a channel, in the units of training.
//! - **segment**: the samples of one trial, whisk or window.
//! - **outcome**: the class that a recogniser names, and after how many samples.
//!
//! [`Bayes`] wraps naive Bayes under any rule; [`Picked`] lets a recogniser
//! take only some channels (x alone, y alone, one whisker).

use std::vec::Vec;

use tactile::{Decision, DecisionRule, Model, NaiveBayes, Posteriors, Quantiser, SetupError};

/// What a recogniser found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Outcome {
    /// The class, from zero, in the order of training.
    pub class: usize,
    /// Samples that it took since the last outcome (or the start).
    pub samples: u32,
}

/// Anything that names a class from a stream of samples.
pub trait Recogniser {
    /// Takes one sample of all channels; gives an outcome where one falls.
    /// A sample of another number of channels is not taken.
    fn push(&mut self, sample: &[f64]) -> Option<Outcome>;

    /// The end of the segment: an outcome of those that wait for it. Then as new.
    fn finish(&mut self) -> Option<Outcome>;

    /// Forgets all samples.
    fn reset(&mut self);
}

/// The first outcome of a segment, its samples one after another, each of
/// `channels` values; starts and ends as new. `None` if no outcome falls, not
/// even at the end, or there are no channels.
///
/// ```
/// use classifiers::recogniser::{Outcome, Recogniser, first_outcome};
///
/// /// Counts.
/// struct Third(u32);
///
/// impl Recogniser for Third {
///     fn push(&mut self, _: &[f64]) -> Option<Outcome> {
///         self.0 += 1;
///         (self.0 == 3).then_some(Outcome { class: 0, samples: 3 })
///     }
///     fn finish(&mut self) -> Option<Outcome> {
///         None
///     }
///     fn reset(&mut self) {
///         self.0 = 0;
///     }
/// }
/// assert!(first_outcome(&mut Third(0), &[0.0; 8], 2).is_some());
/// assert!(first_outcome(&mut Third(0), &[0.0; 4], 2).is_none());
/// ```
pub fn first_outcome(
    recogniser: &mut (impl Recogniser + ?Sized),
    segment: &[f64],
    channels: usize,
) -> Option<Outcome> {
    if channels == 0 {
        return None;
    }
    recogniser.reset();
    let found = segment
        .chunks_exact(channels)
        .find_map(|sample| recogniser.push(sample))
        .or_else(|| recogniser.finish());
    recogniser.reset();
    found
}

/// All outcomes of a segment, in order; see [`first_outcome`].
pub fn outcomes(
    recogniser: &mut (impl Recogniser + ?Sized),
    segment: &[f64],
    channels: usize,
) -> Vec<Outcome> {
    if channels == 0 {
        return Vec::new();
    }
    recogniser.reset();
    let mut found: Vec<Outcome> = segment
        .chunks_exact(channels)
        .filter_map(|sample| recogniser.push(sample))
        .collect();
    found.extend(recogniser.finish());
    recogniser.reset();
    found
}

/// Naive Bayes by the code of a board: samples become codes by the quantisers
/// of the model.
#[derive(Debug, Clone)]
pub struct Bayes<'m, R: DecisionRule> {
    classifier: NaiveBayes<R, &'m [u32]>,
    quantisers: Vec<Quantiser>,
    codes: Vec<i32>,
}

impl<'m, R: DecisionRule> Bayes<'m, R> {
    /// A model under a rule.
    ///
    /// # Errors
    ///
    /// The rule's settings do not fit the model.
    pub fn new(model: Model<&'m [u32]>, settings: R::Settings) -> Result<Self, SetupError> {
        let quantisers: Vec<_> = (0..model.channels())
            .filter_map(|channel| model.quantiser(channel))
            .collect();
        Ok(Self {
            classifier: NaiveBayes::new(model, settings)?,
            codes: Vec::with_capacity(quantisers.len()),
            quantisers,
        })
    }

    /// Posterior of each class after the last full block.
    pub fn posteriors(&self) -> Posteriors {
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

    fn reset(&mut self) {
        self.classifier.reset();
    }
}

/// A recogniser that takes some channels of a sample: trained on x alone it
/// can be asked with x and y. See [`pick`] for training.
#[derive(Debug, Clone)]
pub struct Picked<R> {
    recogniser: R,
    channels: Vec<usize>,
    taken: Vec<f64>,
}

impl<R> Picked<R> {
    /// Of each sample, the recogniser takes these channels, in this order.
    pub fn new(recogniser: R, channels: &[usize]) -> Self {
        Self {
            recogniser,
            channels: channels.to_vec(),
            taken: Vec::with_capacity(channels.len()),
        }
    }
}

impl<R: Recogniser> Recogniser for Picked<R> {
    fn push(&mut self, sample: &[f64]) -> Option<Outcome> {
        self.taken.clear();
        let taken = self.channels.iter().filter_map(|&c| sample.get(c));
        self.taken.extend(taken);
        // Where a channel is missing the recogniser refuses the sample.
        self.recogniser.push(&self.taken)
    }

    fn finish(&mut self) -> Option<Outcome> {
        self.recogniser.finish()
    }

    fn reset(&mut self) {
        self.recogniser.reset();
    }
}

/// Some channels of a segment, sample by sample in the given order: what a
/// recogniser in [`Picked`] is trained on. Empty if `channels` is zero or a
/// picked one is not among them.
pub fn pick(segment: &[f64], channels: usize, picked: &[usize]) -> Vec<f64> {
    if channels == 0 || picked.iter().any(|&c| c >= channels) {
        return Vec::new();
    }
    segment
        .chunks_exact(channels)
        .flat_map(|sample| picked.iter().filter_map(|&c| sample.get(c)).copied())
        .collect()
}
