//! What a rule is: when to decide, from the sums of blocks.

use crate::class_setting::ClassSettings;
use crate::decision::Decision;
use crate::error::SetupError;
use crate::evidence::EvidenceScale;
use crate::model::Model;
use crate::words::Words;

/// When a [`crate::NaiveBayes`] decides. Sums are log-likelihoods, an entry of
/// the table a sample and channel, one sum a class of the model.
pub trait DecisionRule: Sized {
    /// What it is made from, beside the model.
    type Settings;

    /// What is kept from block to block.
    type Evidence: Clone + core::fmt::Debug;

    /// The rule for a model.
    ///
    /// # Errors
    /// The settings do not fit the model.
    fn new<W: Words>(model: &Model<W>, settings: Self::Settings) -> Result<Self, SetupError>;

    /// Takes priors and thresholds of classes; evidence has to start again from these priors.
    fn set_classes(&mut self, classes: &ClassSettings);

    /// Those that it has.
    fn classes(&self) -> &ClassSettings;

    /// Evidence of the priors, which are equal unless classes have others.
    fn start(&self) -> Self::Evidence;

    /// Takes in the sums of a full block and leaves zeros; a decision starts again
    /// from the prior.
    fn end_of_block(&self, sums: &mut [u32], evidence: &mut Self::Evidence) -> Option<Decision>;

    /// Takes in the sums of a full block and leaves zeros, and does not decide.
    fn gather(&self, sums: &mut [u32], evidence: &mut Self::Evidence) {
        let _ = self.end_of_block(sums, evidence);
    }

    /// A touch begins: no class is left further behind the leader than `limit`, in
    /// units of [`Self::scale`], and its prior. Rules of the papers know no touches.
    fn limit(&self, _evidence: &mut Self::Evidence, _limit: u32) {}

    /// How far each class lies behind the leader, in units of [`Self::scale`];
    /// `deficits` has a place for each class.
    fn deficits(&self, evidence: &Self::Evidence, deficits: &mut [u32]);

    /// That it is one of two of `classes`, which exceed a threshold together. Rules of the
    /// papers do not ask.
    fn decide_between(&self, _classes: usize, _evidence: &Self::Evidence) -> Option<Decision> {
        None
    }

    /// The scale of the deficits.
    fn scale(&self) -> EvidenceScale;
}
