//! What changes as the samples of one whisker come in, and the steps that all
//! classifiers share: look up the log-likelihoods of a sample, add them to the sums of
//! the open block, at its end those of its roughness.

use core::fmt;

use crate::decision::{Decision, Reason};
use crate::model::Model;
use crate::rule::DecisionRule;
use crate::sums::Sums;
use crate::words::{JOINT, Words};

/// A sample with another number of channels than the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WrongChannels {
    /// Of the model.
    pub expected: usize,
    /// Of the sample.
    pub found: usize,
}

impl fmt::Display for WrongChannels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { expected, found } = self;
        write!(f, "a sample of {found} channels; the model has {expected}")
    }
}

impl core::error::Error for WrongChannels {}

/// Sums of the open block, and evidence of the blocks before.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct StreamState<E> {
    pub(crate) sums: Sums,
    pub(crate) evidence: E,
    /// The number of the touch.
    pub(crate) touch: u16,
}

#[inline]
fn check<W: Words>(model: &Model<W>, codes: &[i32]) -> Result<(), WrongChannels> {
    let expected = model.channels();
    let found = codes.len();
    if found == expected {
        Ok(())
    } else {
        Err(WrongChannels { expected, found })
    }
}

impl<E> StreamState<E> {
    /// Nothing is seen yet, all classes are equal.
    pub(crate) fn new<R: DecisionRule<Evidence = E>>(rule: &R) -> Self {
        Self {
            sums: Sums::new(rule.interval()),
            evidence: rule.start(),
            touch: 0,
        }
    }

    /// Takes a sample that counts; whether it was the last of its block of `interval`.
    #[inline]
    pub(crate) fn push<W: Words>(
        &mut self,
        model: &Model<W>,
        codes: &[i32],
        interval: u32,
    ) -> Result<bool, WrongChannels> {
        check(model, codes)?;
        Ok(self.sums.push(model, codes, interval))
    }

    /// Takes a sample that does not count.
    #[inline]
    pub(crate) fn pass<W: Words>(
        &mut self,
        model: &Model<W>,
        codes: &[i32],
    ) -> Result<(), WrongChannels> {
        check(model, codes)?;
        if model.has_roughness() {
            self.sums.roughness.push(codes, false);
        }
        Ok(())
    }

    /// A touch begins.
    pub(crate) fn begin_touch<R, W>(&mut self, model: &Model<W>, rule: &R, number: u16)
    where
        R: DecisionRule<Evidence = E>,
        W: Words,
    {
        self.touch = number;
        let Some(touch) = model.touch_rule() else {
            return;
        };
        let limit = touch.limit.saturating_mul(model.block());
        rule.limit(&mut self.evidence, limit);
        self.sums.clear(rule.interval());
    }

    /// Samples are missing before the next.
    pub(crate) const fn interrupt(&mut self) {
        if JOINT {
            self.sums.roughness.interrupt();
        }
    }

    /// Adds what the roughness of a full block says, and begins the next; the block's
    /// sums.
    #[inline]
    pub(crate) fn close_block<R, W>(&mut self, model: &Model<W>, rule: &R) -> (&mut [u32], &mut E)
    where
        R: DecisionRule<Evidence = E>,
        W: Words,
    {
        if model.has_roughness() || model.has_floors() {
            self.sums.end_of_block(model.parts());
        }
        self.sums.left = rule.interval();
        let of_classes = self.sums.classes.get_mut(..model.classes());
        (of_classes.unwrap_or_default(), &mut self.evidence)
    }

    /// The end of a block of a stream that decides by itself.
    // Once a block: apart from the samples, which then need less of the stack.
    #[inline(never)]
    pub(crate) fn end_of_block<R, W>(&mut self, model: &Model<W>, rule: &R) -> Option<Decision>
    where
        R: DecisionRule<Evidence = E>,
        W: Words,
    {
        let (sums, evidence) = self.close_block(model, rule);
        let decision = rule.end_of_block(sums, evidence)?;
        let excess = self.excess(decision.leader());
        let is_below = model.has_floors() && excess.iter().any(|tables| *tables < 0);
        Some(decision.in_touch(self.touch, is_below.then_some(Reason::Unknown)))
    }

    /// By how much a class exceeds its floors since the touch began: in samples, in
    /// roughness.
    #[inline]
    pub(crate) fn excess(&self, class: usize) -> [i32; 2] {
        self.sums.excess.get(class).copied().unwrap_or_default()
    }
}
