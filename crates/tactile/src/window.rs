//! Maximum likelihood over fixed windows (LEP10): the class of the largest
//! summed log-likelihood over each run of N samples; with priors of classes the largest
//! posterior (LEP12 eq. 4).

use crate::class_setting::ClassSettings;
use crate::decision::Decision;
use crate::error::SetupError;
use crate::evidence::EvidenceScale;
use crate::model::Model;
use crate::naive_bayes::NaiveBayes;
use crate::opinion::Section;
use crate::rule::DecisionRule;
use crate::totals::Totals;
use crate::words::Words;

/// A classifier by fixed windows, made from a model and N.
pub type Window<W = &'static [u32]> = NaiveBayes<WindowRule, W>;

/// The window rule. Evidence is the sum of block means, as in the sequential
/// rule; so is the scale of the posterior it states.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WindowRule {
    block: u32,
    window: u32,
    scale: EvidenceScale,
    classes: ClassSettings,
}

impl DecisionRule for WindowRule {
    /// N: decides after every so many samples, a multiple of the model's block.
    type Settings = u32;
    type Evidence = Totals;

    fn new<W: Words>(model: &Model<W>, window: u32) -> Result<Self, SetupError> {
        if model.opinion().is_some_and(Section::names) {
            return Err(SetupError::WindowNames);
        }
        let block = model.block();
        if window == 0 || !window.is_multiple_of(block) {
            return Err(SetupError::Window { window, block });
        }
        Ok(Self {
            block,
            window,
            scale: EvidenceScale::per_samples(block),
            classes: ClassSettings::NONE,
        })
    }

    /// Priors count; a window has no threshold.
    fn set_classes(&mut self, classes: &ClassSettings) {
        self.classes = *classes;
    }

    fn classes(&self) -> &ClassSettings {
        &self.classes
    }

    fn start(&self) -> Totals {
        Totals::of_priors(&self.classes, self.block)
    }

    // Once a block: apart from the samples, and as small as this crate is built.
    #[inline(never)]
    fn end_of_block(&self, sums: &mut [u32], totals: &mut Totals) -> Option<Decision> {
        totals.add(sums, self.block);
        sums.fill(0);
        if totals.samples() < self.window {
            return None;
        }
        let decision = totals.decide(sums.len(), self.scale);
        *totals = self.start();
        Some(decision)
    }

    fn deficits(&self, totals: &Totals, deficits: &mut [u32]) {
        totals.deficits(deficits);
    }

    fn scale(&self) -> EvidenceScale {
        self.scale
    }
}
