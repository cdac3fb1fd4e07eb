//! A stream of samples under a rule: look up, add, and at the end of each
//! block ask the rule. Configuration is immutable and shared; all that changes
//! is a [`State`].

use crate::error::SetupError;
use crate::evidence::Scale;
use crate::likelihoods::{Classes, Likelihoods, Sums, Supported};
use crate::model::Model;

use crate::decision::Decision;

/// What is done with the sums of a block.
pub trait Rule<const K: usize> {
    /// What is kept from block to block.
    type Evidence: Clone;

    /// Samples in a block; not zero.
    fn interval(&self) -> u32;

    /// Evidence of equal priors.
    fn start(&self) -> Self::Evidence;

    /// Takes in a full block; a decision starts again from the prior.
    fn end_of_block(&self, sums: &mut Sums<K>, evidence: &mut Self::Evidence) -> Option<Decision>;

    /// The end of a whisk or of a recording with `samples` in the open block.
    /// Rules that decide on the way drop what is left.
    fn finish(
        &self,
        _sums: &mut Sums<K>,
        _samples: u32,
        _evidence: &mut Self::Evidence,
    ) -> Option<Decision> {
        None
    }

    /// How far each class lies behind the leader, in units of [`Self::scale`].
    fn deficits(&self, evidence: &Self::Evidence) -> [u32; K];

    /// The scale of the deficits.
    fn scale(&self) -> Scale;
}

/// What changes as samples come in. What every sample changes stands first,
/// where the short offsets of small cores reach.
#[derive(Debug, Clone, PartialEq, Eq)]
#[repr(C)]
pub struct State<E, const K: usize> {
    /// Samples to the end of the open block; not zero.
    left: u32,
    sums: Sums<K>,
    evidence: E,
}

/// A likelihood model under a rule, for C channels and K classes.
#[derive(Debug)]
pub struct Streaming<'m, R, const C: usize, const K: usize>
where
    Classes<K>: Supported,
{
    likelihoods: Likelihoods<'m, C, K>,
    rule: R,
}

impl<'m, R: Rule<K>, const C: usize, const K: usize> Streaming<'m, R, C, K>
where
    Classes<K>: Supported,
{
    /// Joins a model and a rule made for it.
    pub(crate) fn with_rule(model: &Model<'m>, rule: R) -> Result<Self, SetupError> {
        Ok(Self {
            likelihoods: Likelihoods::new(model)?,
            rule,
        })
    }

    /// The state before the first sample: nothing seen, all classes equal.
    pub fn state(&self) -> State<R::Evidence, K> {
        start(&self.rule)
    }

    /// Takes one sample of all channels, as codes of the model's quantisers.
    /// A decision may fall with the last sample of a block.
    #[inline]
    pub fn push(&self, state: &mut State<R::Evidence, K>, codes: &[i32; C]) -> Option<Decision> {
        self.likelihoods.add(codes, &mut state.sums);
        count(&self.rule, state)
    }

    /// The end of a whisk or of a recording: [`crate::Stationary`] decides
    /// here (None if there was no sample), the other rules drop what they
    /// have. The state is then as new.
    pub fn finish(&self, state: &mut State<R::Evidence, K>) -> Option<Decision> {
        finish(&self.rule, state)
    }

    /// Forgets all evidence.
    pub fn reset(&self, state: &mut State<R::Evidence, K>) {
        *state = self.state();
    }

    /// Posterior of each class after the last full block, in units of 2⁻³²,
    /// at most 2³² − 1. For display: costs a division.
    pub fn posteriors(&self, state: &State<R::Evidence, K>) -> [u32; K] {
        posteriors(&self.rule, state)
    }
}

pub(crate) fn start<R: Rule<K>, const K: usize>(rule: &R) -> State<R::Evidence, K> {
    State {
        left: rule.interval(),
        sums: Sums::default(),
        evidence: rule.start(),
    }
}

/// Counts a sample whose likelihoods are already in the sums.
#[inline]
pub(crate) fn count<R: Rule<K>, const K: usize>(
    rule: &R,
    state: &mut State<R::Evidence, K>,
) -> Option<Decision> {
    state.left = state.left.wrapping_sub(1);
    if state.left != 0 {
        return None;
    }
    state.left = rule.interval();
    rule.end_of_block(&mut state.sums, &mut state.evidence)
}

pub(crate) fn finish<R: Rule<K>, const K: usize>(
    rule: &R,
    state: &mut State<R::Evidence, K>,
) -> Option<Decision> {
    let samples = rule.interval().saturating_sub(state.left);
    let decision = rule.finish(&mut state.sums, samples, &mut state.evidence);
    *state = start(rule);
    decision
}

pub(crate) fn posteriors<R: Rule<K>, const K: usize>(
    rule: &R,
    state: &State<R::Evidence, K>,
) -> [u32; K] {
    rule.scale().posteriors(&rule.deficits(&state.evidence))
}

impl<E, const K: usize> State<E, K> {
    /// The sums of the open block, for another way to look samples up.
    #[cfg(feature = "std")]
    pub(crate) fn sums_mut(&mut self) -> &mut Sums<K> {
        &mut self.sums
    }
}
