//! The classifier of a module: the whiskers that are heard under one model and rule.

use heapless::Vec;
use serde::{Deserialize, Serialize};

use crate::any_rule::{AnyEvidence, AnyRule, RuleSettings};
use crate::class_setting::ClassSettings;
use crate::constants::Constants;
use crate::decision::Decision;
use crate::elsewhere::{Elsewhere, Felt};
use crate::error::SetupError;
use crate::evidence::leader;
use crate::format::MAX_STREAMS;
use crate::model::Model;
use crate::naive_bayes::{Posteriors, posteriors};
use crate::opinion::Pose;
use crate::rule::DecisionRule;
use crate::sequential::{SequentialEvidence, SequentialRule};
use crate::stream::{StreamState, WrongChannels, reason};
use crate::words::Words;

/// Which whiskers decide, and by what.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Deciding {
    /// The first, by its own evidence; no other is heard.
    First,
    /// Each, by its own evidence, as [`crate::NaiveBayes`] does.
    Each,
    /// All together: the evidence of each is added, log-likelihoods of samples that are
    /// independent given the class (LEP12 eq. 3). Priors count once.
    ///
    /// After each block of a whisker the posterior of the sum is compared with the
    /// threshold. A decision is for none of the classes if the whiskers that had a part in
    /// it lie together below a floor of its class (those of another board of a head: of the class
    /// that is likeliest to them), each since the onset of its touch. It
    /// bears the number of the touch whose block made it fall, and the samples of all;
    /// after it every whisker starts again from the prior. Windows cannot be added: each
    /// counts the samples of one whisker.
    Together,
}

impl Deciding {
    /// How many of a module's whiskers are heard.
    pub const fn heard(self, whiskers: usize) -> usize {
        match self {
            Self::First if whiskers > 1 => 1,
            _ => whiskers,
        }
    }
}

/// The classifier of a module: a model, a rule, and the evidence of each whisker that is
/// heard, which is a *stream* of samples. `W` says where the model lies (see [`Model`]).
#[derive(Debug, Clone)]
pub struct StreamClassifier<W = &'static [u32]> {
    constants: Constants<AnyRule, W>,
    streams: Vec<StreamState<AnyRule>, MAX_STREAMS>,
    deciding: Deciding,
    heard: usize,
    elsewhere: Elsewhere,
}

impl<W: Words> StreamClassifier<W> {
    /// Joins a model and a rule for a module of so many whiskers; nothing is seen yet, all
    /// classes are equal.
    ///
    /// # Errors
    /// The settings do not fit the model or one another, there are no whiskers or more than
    /// [`MAX_STREAMS`] to hear, or the program was built without what is asked for.
    pub fn new(
        model: Model<W>,
        rule: RuleSettings,
        deciding: Deciding,
        whiskers: usize,
    ) -> Result<Self, SetupError> {
        let mut classifier = Self::unstarted(model, rule, deciding, whiskers)?;
        classifier.restart();
        Ok(classifier)
    }

    /// The same without the evidence of its whiskers, which hears nothing before it
    /// [restarts](Self::restart): for a board, whose stack has no room for both.
    ///
    /// # Errors
    /// As [`Self::new`].
    #[inline]
    pub fn unstarted(
        model: Model<W>,
        rule: RuleSettings,
        deciding: Deciding,
        whiskers: usize,
    ) -> Result<Self, SetupError> {
        check(rule, deciding)?;
        let constants = Constants::new(model, rule)?;
        let heard = deciding.heard(whiskers);
        if !(1..=MAX_STREAMS).contains(&heard) {
            return Err(SetupError::Whiskers(heard));
        }
        Ok(Self {
            constants,
            streams: Vec::new(),
            deciding,
            heard,
            elsewhere: Elsewhere::new(),
        })
    }

    /// The model.
    pub const fn model(&self) -> &Model<W> {
        &self.constants.model
    }

    /// What no sample changes.
    pub const fn constants(&self) -> &Constants<AnyRule, W> {
        &self.constants
    }

    /// Which whiskers decide, and by what.
    pub const fn deciding(&self) -> Deciding {
        self.deciding
    }

    /// How many whiskers are heard.
    pub const fn streams(&self) -> usize {
        self.heard
    }

    /// Takes a sample of a stream that counts, as [`crate::NaiveBayes::push`]; a stream that
    /// is not there takes none. Two codes to a model of more channels are of the stream's own
    /// tables, its channels 2n and 2n + 1 (BIOTACT eq. 15).
    ///
    /// # Errors
    /// As [`crate::NaiveBayes::push`].
    #[inline]
    pub fn push_to(
        &mut self,
        stream: usize,
        codes: &[i32],
    ) -> Result<Option<Decision>, WrongChannels> {
        let is_sum = self.is_sum();
        let Constants { model, rule } = &self.constants;
        let Some(one) = self.streams.get_mut(stream) else {
            return Ok(None);
        };
        if !one.push(model, codes, Some(stream))? {
            return Ok(None);
        }
        Ok(if is_sum {
            self.end_of_sum(stream)
        } else {
            one.end_of_block(model, rule)
        })
    }

    /// Takes a sample of a stream that does not count, as [`crate::NaiveBayes::pass`].
    ///
    /// # Errors
    /// As [`crate::NaiveBayes::push`].
    #[inline]
    pub fn pass_to(&mut self, stream: usize, codes: &[i32]) -> Result<(), WrongChannels> {
        let model = &self.constants.model;
        let one = self.streams.get_mut(stream);
        one.map_or(Ok(()), |one| one.pass(model, codes, Some(stream)))
    }

    /// How what a stream touches stands, if it is of this class, by the blocks of its touch so far;
    /// none where the model does not say, or not yet. Of a decision it is asked at once.
    pub fn pose(&self, stream: usize, class: usize) -> Option<Pose> {
        let section = self.model().opinion()?;
        self.streams.get(stream)?.pose(section, class)
    }

    /// The number of the touch of a stream, or of its last one.
    #[inline]
    pub fn touch_of(&self, stream: usize) -> u16 {
        self.streams.get(stream).map_or(0, |stream| stream.touch)
    }

    /// A touch of a stream begins, as [`crate::NaiveBayes::touch`].
    pub fn begin_touch(&mut self, stream: usize, number: u16) {
        if let Some(stream) = self.streams.get_mut(stream) {
            let Constants { model, rule } = &self.constants;
            stream.begin_touch(model, rule, number);
        }
    }

    /// Samples of a stream are missing, as [`crate::NaiveBayes::interrupt`].
    pub fn interrupt_stream(&mut self, stream: usize) {
        if let Some(stream) = self.streams.get_mut(stream) {
            stream.interrupt();
        }
    }

    /// Other settings of the rule take effect; evidence stays, unless it is that of the
    /// other rule: then all streams start again.
    ///
    /// # Errors
    /// As [`Self::new`]; nothing has changed.
    pub fn set_rule(&mut self, settings: RuleSettings) -> Result<(), SetupError> {
        check(settings, self.deciding)?;
        let before = core::mem::discriminant(&self.constants.rule);
        self.constants.set_rule(settings)?;
        if core::mem::discriminant(&self.constants.rule) != before {
            self.restart();
        }
        Ok(())
    }

    /// Priors and thresholds of classes take effect; all evidence is forgotten.
    pub fn set_classes(&mut self, classes: &ClassSettings) {
        self.constants.rule.set_classes(classes);
        self.restart();
    }

    /// The same where they are others; else evidence stays.
    pub fn change_classes(&mut self, classes: &ClassSettings) {
        if self.constants.rule.classes() != classes {
            self.set_classes(classes);
        }
    }

    /// Forgets all evidence.
    pub fn restart(&mut self) {
        const UNSTARTED: StreamState<AnyRule> = StreamState::unstarted(AnyEvidence::NONE);
        let Constants { model, rule } = &self.constants;
        for _ in self.streams.len()..self.heard.min(MAX_STREAMS) {
            // No more than there is room for.
            let _ = self.streams.push(UNSTARTED);
        }
        for stream in &mut self.streams {
            stream.restart(model, rule);
        }
        self.elsewhere.forget();
    }

    /// Whether another board of its head decides for all whiskers together. This one then only
    /// gathers [evidence](Self::evidence) for it.
    pub fn set_led(&mut self, is_led: bool) {
        self.elsewhere.set_led(is_led);
    }

    /// What its whiskers together have felt since the last decision; none: nothing, or each
    /// decides by itself.
    pub fn evidence(&self) -> Option<Felt> {
        let Constants { model, rule } = &self.constants;
        let AnyRule::Sequential(of_sum) = rule else {
            return None;
        };
        let mut begun = self.streams.iter().filter(|one| one.evidence.is_begun());
        if !self.is_sum() || begun.next().is_none() {
            return None;
        }
        let all = self.streams.iter();
        let all = all.filter_map(|one| one.evidence.sequential());
        let sum = of_sum.sum(model.classes(), all);
        let leader = leader(&sum.deficits());
        Some(Felt::of(&sum, self.excess(leader), model.block()))
    }

    /// What the whiskers of another board have felt by now; none: it does not live. A decision
    /// may fall by it.
    pub fn hear(&mut self, board: usize, felt: Option<&Felt>) -> Option<Decision> {
        let block = self.constants.model.block();
        self.elsewhere.hear(board, felt, block);
        if felt.is_none() || !self.is_sum() || self.elsewhere.is_led() {
            return None;
        }
        self.decide_by_sum(None)
    }

    /// By how much a class exceeds its floors, by the whiskers that have a part in what is felt.
    fn excess(&self, class: usize) -> [i32; 2] {
        let mut excess = [0_i32; 2];
        for stream in self.streams.iter().filter(|one| one.evidence.is_begun()) {
            for (sum, own) in excess.iter_mut().zip(stream.excess(class)) {
                *sum = sum.saturating_add(own);
            }
        }
        excess
    }

    /// The whiskers of the head together have decided: what led there is forgotten.
    pub fn forget(&mut self) {
        let rule = &self.constants.rule;
        for stream in &mut self.streams {
            if stream.evidence.is_begun() {
                stream.evidence = rule.start();
                stream.spend();
            }
        }
        self.elsewhere.forget();
    }

    /// Posterior of each class after the last full block, by which a stream would decide;
    /// see [`crate::NaiveBayes::posteriors`].
    pub fn posteriors(&self, stream: usize) -> Posteriors {
        let Constants { model, rule } = &self.constants;
        if let AnyRule::Sequential(of_sum) = rule
            && self.is_sum()
        {
            let sum = sum(of_sum, model.classes(), (&self.streams, &self.elsewhere));
            return posteriors(model, rule, &AnyEvidence::Sequential(sum));
        }
        match self.streams.get(stream) {
            Some(stream) => posteriors(model, rule, &stream.evidence),
            None => posteriors(model, rule, &rule.start()),
        }
    }

    #[inline]
    fn is_sum(&self) -> bool {
        cfg!(feature = "several") && self.deciding == Deciding::Together
    }

    /// The end of a block of stream `n`, where all decide together.
    // Once a block: apart from the samples, which then need less of the stack.
    #[inline(never)]
    fn end_of_sum(&mut self, n: usize) -> Option<Decision> {
        let Constants { model, rule } = &self.constants;
        // No other adds up.
        let AnyRule::Sequential(of_sum) = rule else {
            return None;
        };
        let stream = self.streams.get_mut(n)?;
        let touch = stream.touch;
        let (sums, evidence) = stream.close_block(model);
        of_sum.gather(sums, evidence.sequential_mut()?);
        if self.elsewhere.is_led() {
            return None;
        }
        self.decide_by_sum(Some((n, touch)))
    }

    /// Decides by all evidence there is, as stream and touch say more, or another board.
    #[inline]
    fn decide_by_sum(&mut self, by: Option<(usize, u16)>) -> Option<Decision> {
        let Constants { model, rule } = &self.constants;
        let AnyRule::Sequential(of_sum) = rule else {
            return None;
        };
        let section = model.opinion();
        let stream = by.and_then(|(n, _)| self.streams.get(n));
        if stream.is_some_and(|stream| stream.is_early(section)) {
            return None;
        }
        let sum = sum(of_sum, model.classes(), (&self.streams, &self.elsewhere));
        let decision = of_sum.decide_by(model.classes(), &sum)?;

        let leader = decision.leader();
        let objection = stream.and_then(|one| one.objection(section, model.classes(), leader));
        let mut excess = self.excess(leader);
        let elsewhere = self.elsewhere.excess(model.block());
        for (sum, more) in excess.iter_mut().zip(elsewhere) {
            *sum = sum.saturating_add(more);
        }
        let is_below = model.has_floors() && excess.iter().any(|tables| *tables < 0);
        let has_opinion = section.is_some();
        self.forget();
        let touch = by.map_or(0, |(_, touch)| touch);
        let decision = decision.in_touch(touch, reason(is_below, objection));
        match by.and_then(|(n, _)| self.streams.get_mut(n)) {
            Some(stream) => stream.say(has_opinion, decision),
            None => Some(decision),
        }
    }
}

/// The evidence of all streams together.
// Not within what is generic: there once, and as small as this crate is built.
#[inline(never)]
fn sum(
    rule: &SequentialRule,
    classes: usize,
    (streams, elsewhere): (&[StreamState<AnyRule>], &Elsewhere),
) -> SequentialEvidence {
    let all = streams
        .iter()
        .filter_map(|stream| stream.evidence.sequential());
    rule.sum(classes, all.chain(elsewhere.iter()))
}

/// Whether whiskers can decide so by a rule, and whether the program has the code for it.
fn check(rule: RuleSettings, deciding: Deciding) -> Result<(), SetupError> {
    match (rule, deciding) {
        (_, Deciding::Each | Deciding::Together) if !cfg!(feature = "several") => {
            Err(SetupError::NotBuilt("several whiskers"))
        }
        (RuleSettings::Window(_), Deciding::Together) => Err(SetupError::WindowTogether),
        _ => Ok(()),
    }
}
