//! The sequential probability ratio test between two classes (LEP12 eqs. 1 and 2), on the tables
//! of a model of naive Bayes.
//!
//! log PR = log HR + Σ log LR, with the prior ratio HR = P(H₁)/P(H₂) and the likelihood ratio LR
//! of each block, the mean over its samples as in LEP12 eq. 6. H₁ is decided where log PR is
//! log(θ/(1 − θ)) or more, H₂ where −log PR is.

use std::vec::Vec;

use tactile::{Binner, Model, Quantiser, SetupError};

use crate::recogniser::{Outcome, Recogniser};

/// A channel's likelihood ratio.
#[derive(Debug, Clone)]
struct Channel {
    quantiser: Quantiser,
    binner: Binner,
    /// log LR of each bin.
    ratios: Vec<f64>,
}

/// The test: class 0 of the model is H₁, class 1 is H₂.
#[derive(Debug, Clone)]
pub struct Sprt {
    channels: Vec<Channel>,
    block: u32,
    /// log HR.
    prior: f64,
    /// log(θ/(1 − θ)).
    threshold: f64,
    /// log PR so far.
    ratio: f64,
    /// Σ log LR of the block, and samples since the start.
    sum: f64,
    samples: u32,
}

impl Sprt {
    /// The test with a threshold θ on the probability, above 0.5 and below 1, and the prior ratio
    /// HR, above 0 and finite.
    ///
    /// # Errors
    /// [`SetupError::Threshold`] if one of them is not in its range, or the model has no two
    /// classes.
    pub fn new(model: Model<&[u32]>, theta: f64, prior_ratio: f64) -> Result<Self, SetupError> {
        let threshold = libm::log(theta / (1.0 - theta));
        let prior = libm::log(prior_ratio);
        if !(threshold > 0.0 && threshold.is_finite() && prior.is_finite()) || model.classes() < 2 {
            return Err(SetupError::Threshold);
        }
        let channel = |n: usize| {
            let (bins, quantiser) = (model.bins(n)?, model.quantiser(n)?);
            let log2 = |bin, class| model.log2_likelihood(n, bin, class).map(f64::from);
            let ratio = |bin| Some(core::f64::consts::LN_2 * (log2(bin, 0)? - log2(bin, 1)?));
            Some(Channel {
                quantiser,
                binner: quantiser.binner(bins).ok()?,
                ratios: (0..bins).map(ratio).collect::<Option<_>>()?,
            })
        };
        Ok(Self {
            channels: (0..model.channels()).filter_map(channel).collect(),
            block: model.block(),
            prior,
            threshold,
            ratio: prior,
            sum: 0.0,
            samples: 0,
        })
    }
}

impl Recogniser for Sprt {
    fn push(&mut self, sample: &[f64]) -> Option<Outcome> {
        if sample.len() != self.channels.len() {
            return None;
        }
        for (channel, x) in self.channels.iter().zip(sample) {
            let code = channel.quantiser.code_from_f64(*x);
            let bin = channel
                .binner
                .bin(code, channel.ratios.len().saturating_sub(1));
            self.sum += channel.ratios.get(bin).copied().unwrap_or(0.0);
        }
        self.samples = self.samples.saturating_add(1);
        if !self.samples.is_multiple_of(self.block.max(1)) {
            return None;
        }
        self.ratio += core::mem::take(&mut self.sum) / f64::from(self.block.max(1));
        let is_decided = self.ratio.abs() >= self.threshold;
        let outcome = Outcome {
            class: usize::from(self.ratio < 0.0),
            samples: self.samples,
        };
        if is_decided {
            self.reset();
        }
        is_decided.then_some(outcome)
    }

    /// What is undecided stays so.
    fn finish(&mut self) -> Option<Outcome> {
        self.reset();
        None
    }

    fn reset(&mut self) {
        (self.ratio, self.sum, self.samples) = (self.prior, 0.0, 0);
    }
}
