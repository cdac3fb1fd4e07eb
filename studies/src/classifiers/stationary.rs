//! The stationary naive Bayes rule (BIOTACT eq. 15–16): log-likelihoods summed
//! over all samples of a whisk and over all whiskers' channels,
//! log P(C_l | x_1 … x_n) = Σ_w Σ_i log P_w(x_i | C_l), and the largest wins.
//!
//! A whisk may have any length: push its samples, then call
//! [`tactile::NaiveBayes::finish`] at its end for the decision.

use anyhow::Result;
use tactile::{
    Decision, DecisionRule, EvidenceScale, MAX_SAMPLES_TIMES_CHANNELS, Model, SetupError, Totals,
};

/// The stationary rule. Here every sample counts in full (the model's block
/// plays no part), so the posterior is that of independent samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct StationaryRule {
    /// Samples after which sums move from words to double words.
    interval: u32,
}

impl DecisionRule for StationaryRule {
    type Settings = ();
    type Evidence = Totals;

    fn new<W: tactile::Words>(model: &Model<W>, (): ()) -> Result<Self, SetupError> {
        // Channels are 1 to 24.
        let channels = (model.channels() as u32).max(1);
        Ok(Self {
            interval: MAX_SAMPLES_TIMES_CHANNELS / channels,
        })
    }

    fn interval(&self) -> u32 {
        self.interval
    }

    fn start(&self) -> Totals {
        Totals::default()
    }

    fn end_of_block(&self, sums: &mut [u32], totals: &mut Totals) -> Option<Decision> {
        totals.add(sums, self.interval);
        sums.fill(0);
        None
    }

    fn finish(&self, sums: &[u32], samples: u32, mut totals: Totals) -> Option<Decision> {
        totals.add(sums, samples);
        (totals.samples() > 0).then(|| totals.decide(sums.len(), self.scale()))
    }

    fn deficits(&self, totals: &Totals, deficits: &mut [u32]) {
        totals.deficits(deficits);
    }

    fn scale(&self) -> EvidenceScale {
        EvidenceScale::per_samples(1)
    }
}
