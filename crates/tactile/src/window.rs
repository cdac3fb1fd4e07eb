//! Maximum likelihood over fixed windows (LEP10): the class of the largest
//! summed log-likelihood over each run of N samples.

use crate::decision::Decision;
use crate::error::SetupError;
use crate::evidence::{Scale, Totals};
use crate::likelihoods::{Classes, Sums, Supported};
use crate::model::Model;
use crate::streaming::{Rule, Streaming};

/// A classifier by fixed windows, of C channels and K classes.
pub type Window<'m, const C: usize, const K: usize> = Streaming<'m, WindowRule, C, K>;

/// The window rule. Evidence is the sum of block means, as in the sequential
/// rule; so is the scale of the posterior it states.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WindowRule {
    block: u32,
    window: u32,
    scale: Scale,
}

impl<const C: usize, const K: usize> Window<'_, C, K>
where
    Classes<K>: Supported,
{
    /// Decides after every `window` samples.
    ///
    /// # Errors
    ///
    /// The window is zero or not a multiple of the model's block; or the model
    /// has other channels or classes than C and K.
    pub fn new<'m>(model: &Model<'m>, window: u32) -> Result<Window<'m, C, K>, SetupError> {
        Window::with_rule(model, WindowRule::new(model, window)?)
    }
}

impl WindowRule {
    pub(crate) fn new(model: &Model<'_>, window: u32) -> Result<Self, SetupError> {
        let block = model.block();
        if window == 0 || !window.is_multiple_of(block) {
            return Err(SetupError::Window { window, block });
        }
        Ok(Self {
            block,
            window,
            scale: Scale::per_samples(block),
        })
    }
}

impl<const K: usize> Rule<K> for WindowRule {
    type Evidence = Totals<K>;

    #[inline]
    fn interval(&self) -> u32 {
        self.block
    }

    fn start(&self) -> Totals<K> {
        Totals::default()
    }

    #[inline(never)]
    fn end_of_block(&self, sums: &mut Sums<K>, totals: &mut Totals<K>) -> Option<Decision> {
        totals.add(&sums.take(), self.block);
        if totals.samples < self.window {
            return None;
        }
        let (class, posterior) = totals.decide(self.scale);
        *totals = Totals::default();
        Some(Decision::new(class, self.window, posterior))
    }

    fn deficits(&self, totals: &Totals<K>) -> [u32; K] {
        totals.deficits()
    }

    fn scale(&self) -> Scale {
        self.scale
    }
}
