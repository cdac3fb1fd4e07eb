//! The stationary naive Bayes rule (BIOTACT eq. 15–16): log-likelihoods summed
//! over all samples of a whisk and over all whiskers' channels,
//! log P(C_l | x_1 … x_n) = Σ_w Σ_i log P_w(x_i | C_l), and the largest wins.
//!
//! A whisk may have any length: push its samples, then call
//! [`Streaming::finish`] at its end for the decision.

use crate::decision::Decision;
use crate::error::SetupError;
use crate::evidence::{Scale, Totals};
use crate::format::MAX_SAMPLES_TIMES_CHANNELS;
use crate::likelihoods::{Classes, Sums, Supported};
use crate::model::Model;
use crate::streaming::{Rule, Streaming};

/// A whisk-by-whisk classifier of C channels (x and y of each whisker) and K
/// classes.
pub type Stationary<'m, const C: usize, const K: usize> = Streaming<'m, StationaryRule, C, K>;

/// The stationary rule. Here every sample counts in full (the model's block
/// plays no part), so the posterior is that of independent samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StationaryRule {
    /// Samples after which sums move from words to double words.
    interval: u32,
}

impl<const C: usize, const K: usize> Stationary<'_, C, K>
where
    Classes<K>: Supported,
{
    /// Decides at the end of each whisk.
    ///
    /// # Errors
    ///
    /// The model has other channels or classes than C and K.
    pub fn new<'m>(model: &Model<'m>) -> Result<Stationary<'m, C, K>, SetupError> {
        Stationary::with_rule(model, StationaryRule::new(model))
    }
}

impl StationaryRule {
    pub(crate) fn new(model: &Model<'_>) -> Self {
        // Channels are 1 to 24.
        let channels = (model.channels() as u32).max(1);
        Self {
            interval: MAX_SAMPLES_TIMES_CHANNELS / channels,
        }
    }
}

impl<const K: usize> Rule<K> for StationaryRule {
    type Evidence = Totals<K>;

    #[inline]
    fn interval(&self) -> u32 {
        self.interval
    }

    fn start(&self) -> Totals<K> {
        Totals::default()
    }

    #[inline(never)]
    fn end_of_block(&self, sums: &mut Sums<K>, totals: &mut Totals<K>) -> Option<Decision> {
        totals.add(&sums.take(), self.interval);
        None
    }

    fn finish(&self, sums: &mut Sums<K>, samples: u32, totals: &mut Totals<K>) -> Option<Decision> {
        totals.add(&sums.take(), samples);
        if totals.samples == 0 {
            return None;
        }
        let (class, posterior) = totals.decide(Rule::<K>::scale(self));
        Some(Decision::new(class, totals.samples, posterior))
    }

    fn deficits(&self, totals: &Totals<K>) -> [u32; K] {
        totals.deficits()
    }

    fn scale(&self) -> Scale {
        Scale::per_samples(1)
    }
}
