//! What changes as the samples of one whisker come in, and the steps that all
//! classifiers share: look up the log-likelihoods of a sample, add them to the sums of
//! the open block, at its end those of its roughness.

use crate::decision::{Decision, Reason};
use crate::format::{MAX_CLASSES, MAX_STREAMS};
use crate::model::Model;
use crate::opinion::{Judge, Pose, Section};
use crate::rule::DecisionRule;
use crate::sums::Sums;
use crate::words::{JOINT, OPINION, Words};

/// A sample with another number of channels than the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("a sample of {found} channels; the model has {expected}")]
pub struct WrongChannels {
    /// Of the model.
    pub expected: usize,
    /// Of the sample.
    pub found: usize,
}

#[derive(Debug, Clone)]
pub(crate) struct StreamState<R: DecisionRule> {
    pub(crate) sums: Sums,
    pub(crate) evidence: R::Evidence,
    pub(crate) touch: u16,
    /// Of models that object; where the program was built without, there is none.
    judges: [Judge; OPINION as usize],
}

/// The first channel of a sample: that of its own tables, where the stream of this number has
/// any.
#[inline]
fn first_channel<W: Words>(
    model: &Model<W>,
    codes: &[i32],
    stream: Option<usize>,
) -> Result<usize, WrongChannels> {
    let expected = model.channels();
    let found = codes.len();
    if found == expected {
        return Ok(0);
    }
    match stream {
        Some(stream) if MAX_STREAMS > 1 && found == 2 && stream < expected / 2 => Ok(2 * stream),
        _ => Err(WrongChannels { expected, found }),
    }
}

/// Why a decision names no class: the pose explains the rest.
pub(crate) fn reason(is_below: bool, objection: Option<Reason>) -> Option<Reason> {
    match objection {
        Some(Reason::Pose) => objection,
        _ if is_below => Some(Reason::Unknown),
        _ => objection,
    }
}

/// Adds to the sums of a block what scores have risen by, as evidence is held.
fn add_rise(sums: &mut [u32; MAX_CLASSES], rise: &[i32; MAX_CLASSES], block: u32) {
    // In the middle of what a sum may be: only differences count.
    const MIDDLE: i32 = 1 << 29;
    for (sum, rise) in sums.iter_mut().zip(rise) {
        let rise = rise.saturating_mul(block.cast_signed());
        *sum = (MIDDLE + rise.clamp(1 - MIDDLE, MIDDLE - 1)).cast_unsigned();
    }
}

impl<R: DecisionRule> StreamState<R> {
    pub(crate) fn new<W: Words>(model: &Model<W>, rule: &R) -> Self {
        let mut state = Self::unstarted(rule.start());
        state.restart(model, rule);
        state
    }

    /// With this evidence, before it [starts](Self::restart).
    #[inline]
    pub(crate) const fn unstarted(evidence: R::Evidence) -> Self {
        Self {
            sums: Sums::new(0),
            evidence,
            touch: 0,
            judges: [const { Judge::new() }; OPINION as usize],
        }
    }

    /// Forgets all that was seen, where it lies: a board's stack has no room for another.
    pub(crate) fn restart<W: Words>(&mut self, model: &Model<W>, rule: &R) {
        self.sums = Sums::new(model.block());
        self.evidence = rule.start();
        self.touch = 0;
        if let [judge, ..] = self.judges.as_mut_slice() {
            *judge = const { Judge::new() };
            // Until the whisker's own is known, it rests where those of training did.
            let rest = model.opinion().map_or([0; 2], Section::rest);
            judge.opinion.differences.rest = rest;
        }
    }

    /// Takes a sample that counts, of the stream of this number where streams can have tables of
    /// their own; whether it was the last of its block. Where roughness is weighed, one
    /// without a difference is of no block: a sum of fewer would be that of a smoother surface.
    #[inline]
    pub(crate) fn push<W: Words>(
        &mut self,
        model: &Model<W>,
        codes: &[i32],
        stream: Option<usize>,
    ) -> Result<bool, WrongChannels> {
        let first = first_channel(model, codes, stream)?;
        self.feel(model, codes, true);
        if model.has_roughness() && !self.sums.roughness.is_full() {
            self.sums.roughness.push(codes, false);
            return Ok(false);
        }
        Ok(self.sums.push(model, (codes, first)))
    }

    /// Takes a sample that does not count.
    #[inline]
    pub(crate) fn pass<W: Words>(
        &mut self,
        model: &Model<W>,
        codes: &[i32],
        stream: Option<usize>,
    ) -> Result<(), WrongChannels> {
        first_channel(model, codes, stream)?;
        self.feel(model, codes, false);
        if model.has_roughness() {
            self.sums.roughness.push(codes, false);
        }
        Ok(())
    }

    /// What a second opinion needs of a sample.
    #[inline]
    fn feel<W: Words>(&mut self, model: &Model<W>, codes: &[i32], counts: bool) {
        if let (Some(section), [judge, ..]) = (model.opinion(), self.judges.as_mut_slice()) {
            let section = (section, model.classes());
            judge.opinion.push(section, codes, counts);
        }
    }

    pub(crate) fn begin_touch<W: Words>(&mut self, model: &Model<W>, rule: &R, number: u16) {
        self.touch = number;
        let Some(touch) = model.touch_rule() else {
            return;
        };
        if let [judge, ..] = self.judges.as_mut_slice()
            && judge.begin()
        {
            // A touch that was only refused leaves nothing to the next.
            self.evidence = rule.start();
        }
        let limit = touch.limit.saturating_mul(model.block());
        rule.limit(&mut self.evidence, limit);
        self.sums.clear(model.block());
    }

    /// Samples are missing before the next.
    pub(crate) const fn interrupt(&mut self) {
        if JOINT {
            self.sums.roughness.interrupt();
        }
        if let [judge, ..] = self.judges.as_mut_slice() {
            judge.opinion.differences.interrupt();
        }
    }

    /// Adds what the roughness of a full block says, and begins the next; the block's
    /// sums.
    #[inline]
    pub(crate) fn close_block<W: Words>(
        &mut self,
        model: &Model<W>,
    ) -> (&mut [u32], &mut R::Evidence) {
        if model.has_roughness() || model.has_floors() {
            self.sums.end_of_block(model.parts());
        }
        self.sums.left = model.block();
        if let Some(section) = model.opinion()
            && let [judge, ..] = self.judges.as_mut_slice()
        {
            if judge.opinion.is_full() && section.begins_again() {
                judge.opinion.begin_again(section, model.classes());
            }
            let rise = judge.opinion.end_of_block(section, model.classes());
            if section.names() {
                add_rise(&mut self.sums.classes, &rise, model.block());
            }
        }
        let of_classes = self.sums.classes.get_mut(..model.classes());
        (of_classes.unwrap_or_default(), &mut self.evidence)
    }

    /// The end of a block of a stream that decides by itself.
    // Once a block: apart from the samples, which then need less of the stack.
    #[inline(never)]
    pub(crate) fn end_of_block<W: Words>(
        &mut self,
        model: &Model<W>,
        rule: &R,
    ) -> Option<Decision> {
        let _ = self.close_block(model);
        let section = model.opinion();
        let is_early = self.is_early(section);
        let evidence = &mut self.evidence;
        let sums = self.sums.classes.get_mut(..model.classes());
        let sums = sums.unwrap_or_default();
        if let Some(section) = section
            && section.names()
            && let [judge, ..] = self.judges.as_mut_slice()
        {
            return judge.name((section, model.classes()), rule, sums, evidence, self.touch);
        }
        if is_early {
            rule.gather(sums, evidence);
            return None;
        }
        let decision = rule.end_of_block(sums, evidence)?;
        let excess = self.excess(decision.leader());
        let is_below = model.has_floors() && excess.iter().any(|tables| *tables < 0);
        let objection = self.objection(section, model.classes(), decision.leader());
        let decision = decision.in_touch(self.touch, reason(is_below, objection));
        self.say(section.is_some(), decision)
    }

    /// The decision, if it is to be said: without an opinion each is.
    pub(crate) fn say(&mut self, has_opinion: bool, decision: Decision) -> Option<Decision> {
        match self.judges.as_mut_slice() {
            [judge, ..] if has_opinion => judge.say(decision),
            _ => Some(decision),
        }
    }

    pub(crate) fn is_early(&self, section: Option<Section<'_>>) -> bool {
        let judge = self.judges.first();
        section.is_some_and(|section| judge.is_some_and(|judge| judge.opinion.is_early(section)))
    }

    pub(crate) fn objection(
        &self,
        section: Option<Section<'_>>,
        classes: usize,
        class: usize,
    ) -> Option<Reason> {
        let judge = self.judges.first()?;
        judge.opinion.objection(section?, classes, class)
    }

    pub(crate) fn pose(&self, section: Section<'_>, class: usize) -> Option<Pose> {
        self.judges.first()?.opinion.pose(section, class)
    }

    /// The streams together have decided: this touch says no more by itself.
    pub(crate) fn spend(&mut self) {
        if let [judge, ..] = self.judges.as_mut_slice() {
            judge.finish();
        }
    }

    /// By how much a class exceeds its floors since the touch began: in samples, in
    /// roughness.
    #[inline]
    pub(crate) fn excess(&self, class: usize) -> [i32; 2] {
        self.sums.excess.get(class).copied().unwrap_or_default()
    }
}
