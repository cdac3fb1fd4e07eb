//! One way to ask any classifier, for experiments on a PC: samples in, the
//! name of a class out, whatever the method.
//!
//! # Glossary
//!
//! - **sample**: one real number a channel, in the units of training.
//! - **segment**: the samples of one trial, whisk or window.
//! - **outcome**: the class that a recogniser names, and after how many samples.
//!
//! [`Bayes`] wraps the three rules of [`tactile::dynamic`]; [`Picked`] lets a
//! recogniser hear only some channels (x alone, y alone, one whisker).

use std::boxed::Box;
use std::vec::Vec;

use tactile::dynamic::{self, Classifier};
use tactile::{Decision, Model, Quantiser, SetupError, Threshold};

/// What a recogniser found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome {
    /// The class, from zero, in the order of training.
    pub class: usize,
    /// Samples that it took since the last outcome (or the start).
    pub samples: u32,
    /// For a regression, the real number that `class` is rounded from.
    pub value: Option<f64>,
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

impl<R: Recogniser + ?Sized> Recogniser for Box<R> {
    fn push(&mut self, sample: &[f64]) -> Option<Outcome> {
        (**self).push(sample)
    }

    fn finish(&mut self) -> Option<Outcome> {
        (**self).finish()
    }

    fn reset(&mut self) {
        (**self).reset();
    }
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
///         (self.0 == 3).then_some(Outcome { class: 0, samples: 3, value: None })
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
pub struct Bayes<'m> {
    classifier: Box<dyn Classifier + 'm>,
    quantisers: Vec<Quantiser>,
    codes: Vec<i32>,
}

impl<'m> Bayes<'m> {
    /// Sequential analysis (LEP12); see [`tactile::Sequential`].
    ///
    /// # Errors
    ///
    /// None for a parsed model.
    pub fn sequential(model: &Model<'m>, threshold: Threshold) -> Result<Self, SetupError> {
        dynamic::sequential(model, threshold).map(|c| Self::new(model, c))
    }

    /// Maximum likelihood over windows (LEP10); see [`tactile::Window`].
    ///
    /// # Errors
    ///
    /// The window is zero or not a multiple of the model's block.
    pub fn window(model: &Model<'m>, window: u32) -> Result<Self, SetupError> {
        dynamic::window(model, window).map(|c| Self::new(model, c))
    }

    /// Stationary naive Bayes (BIOTACT eq. 15–16), which decides at the end of
    /// a segment; see [`tactile::Stationary`].
    ///
    /// # Errors
    ///
    /// None for a parsed model.
    pub fn stationary(model: &Model<'m>) -> Result<Self, SetupError> {
        dynamic::stationary(model).map(|c| Self::new(model, c))
    }

    fn new(model: &Model<'m>, classifier: Box<dyn Classifier + 'm>) -> Self {
        let quantisers: Vec<_> = (0..model.channels())
            .filter_map(|channel| model.quantiser(channel))
            .collect();
        Self {
            classifier,
            codes: Vec::with_capacity(quantisers.len()),
            quantisers,
        }
    }

    /// Posterior of each class after the last full block.
    pub fn posteriors(&self) -> Vec<f64> {
        self.classifier.posteriors()
    }
}

impl From<Decision> for Outcome {
    fn from(decision: Decision) -> Self {
        Self {
            class: decision.class(),
            samples: decision.samples(),
            value: None,
        }
    }
}

impl Recogniser for Bayes<'_> {
    fn push(&mut self, sample: &[f64]) -> Option<Outcome> {
        if sample.len() != self.quantisers.len() {
            return None;
        }
        self.codes.clear();
        let codes = self.quantisers.iter().zip(sample);
        self.codes.extend(codes.map(|(q, &x)| q.code_from_f64(x)));
        let decision = self.classifier.push(&self.codes).ok().flatten();
        decision.map(Outcome::from)
    }

    fn finish(&mut self) -> Option<Outcome> {
        self.classifier.finish().map(Outcome::from)
    }

    fn reset(&mut self) {
        self.classifier.reset();
    }
}

/// A recogniser that hears some channels of a sample: trained on x alone it
/// can be asked with x and y. See [`pick`] for training.
#[derive(Debug, Clone)]
pub struct Picked<R> {
    recogniser: R,
    channels: Vec<usize>,
    heard: Vec<f64>,
}

impl<R> Picked<R> {
    /// Of each sample, the recogniser hears these channels, in this order.
    pub fn new(recogniser: R, channels: &[usize]) -> Self {
        Self {
            recogniser,
            channels: channels.to_vec(),
            heard: Vec::with_capacity(channels.len()),
        }
    }
}

impl<R: Recogniser> Recogniser for Picked<R> {
    fn push(&mut self, sample: &[f64]) -> Option<Outcome> {
        self.heard.clear();
        let heard = self.channels.iter().filter_map(|&c| sample.get(c));
        self.heard.extend(heard);
        // Where a channel is missing the recogniser refuses the sample.
        self.recogniser.push(&self.heard)
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
