//! Several whiskers under one model and rule: each decides by itself, or all together.

use core::marker::PhantomData;

use crate::constants::Constants;
use crate::decision::Decision;
use crate::error::SetupError;
use crate::model::Model;
use crate::naive_bayes::{Posteriors, posteriors};
use crate::rule::DecisionRule;
use crate::sequential::{SequentialEvidence, SequentialRule};
use crate::stream::{StreamState, Streams, WrongChannels};
use crate::words::Words;

/// Streams of samples under one model and rule, the evidence of each apart. `V` says what
/// they decide by, `K` how many there are.
#[derive(Debug, Clone)]
pub struct Several<V, R: DecisionRule, W, const K: usize> {
    constants: Constants<R, W>,
    streams: [StreamState<R::Evidence>; K],
    decides_by: PhantomData<V>,
}

/// Each stream decides by its own evidence, as [`crate::NaiveBayes`] does.
pub type Each<R, W, const K: usize> = Several<ByOwn, R, W, K>;

/// All streams decide together: the evidence of each is added, log-likelihoods of samples
/// that are independent given the class (LEP12 eq. 3). Equal priors count once.
///
/// After each block of a stream the posterior of the sum is compared with the threshold. A
/// decision is for none of the classes if the streams that had a part in it lie together
/// below a floor of its class, each since the onset of its touch. It bears the number of the
/// touch whose block made it fall, and the samples of all streams; after it every stream
/// starts again from the prior.
pub type Together<W, const K: usize> = Several<BySum, SequentialRule, W, K>;

/// By its own evidence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ByOwn;

/// By the sum of all evidence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BySum;

/// What streams decide by.
pub trait DecidesBy<R: DecisionRule>: sealed::DecidesBy<R> {}

impl<R: DecisionRule> DecidesBy<R> for ByOwn {}
impl DecidesBy<SequentialRule> for BySum {}

mod sealed {
    use super::{Decision, DecisionRule, Model, StreamState, Words};

    /// Its parts are no concern of others.
    pub trait DecidesBy<R: DecisionRule>: Sized {
        /// The end of a block of stream `n`.
        fn end_of_block<W: Words>(
            model: &Model<W>,
            rule: &R,
            streams: &mut [StreamState<R::Evidence>],
            n: usize,
        ) -> Option<Decision>;

        /// The evidence by which stream `n` would decide.
        fn evidence<W: Words>(
            model: &Model<W>,
            rule: &R,
            streams: &[StreamState<R::Evidence>],
            n: usize,
        ) -> R::Evidence;
    }
}

impl<R: DecisionRule> sealed::DecidesBy<R> for ByOwn {
    fn end_of_block<W: Words>(
        model: &Model<W>,
        rule: &R,
        streams: &mut [StreamState<R::Evidence>],
        n: usize,
    ) -> Option<Decision> {
        streams.get_mut(n)?.end_of_block(model, rule)
    }

    fn evidence<W: Words>(
        _model: &Model<W>,
        rule: &R,
        streams: &[StreamState<R::Evidence>],
        n: usize,
    ) -> R::Evidence {
        let stream = streams.get(n);
        stream.map_or_else(|| rule.start(), |stream| stream.evidence.clone())
    }
}

impl sealed::DecidesBy<SequentialRule> for BySum {
    fn end_of_block<W: Words>(
        model: &Model<W>,
        rule: &SequentialRule,
        streams: &mut [StreamState<SequentialEvidence>],
        n: usize,
    ) -> Option<Decision> {
        let stream = streams.get_mut(n)?;
        let touch = stream.touch;
        let (sums, evidence) = stream.close_block(model, rule);
        rule.gather(sums, evidence);
        let sum = Self::evidence(model, rule, streams, n);
        let decision = rule.decide_by(model.classes(), &sum)?;

        let mut excess = [0_i32; 2];
        for stream in streams {
            if stream.evidence.is_begun() {
                let own = stream.excess(decision.leader());
                for (sum, own) in excess.iter_mut().zip(own) {
                    *sum = sum.saturating_add(own);
                }
                stream.evidence = rule.start();
            }
        }
        let is_below = model.has_floors() && excess.iter().any(|tables| *tables < 0);
        Some(decision.in_touch(touch, is_below))
    }

    fn evidence<W: Words>(
        model: &Model<W>,
        _rule: &SequentialRule,
        streams: &[StreamState<SequentialEvidence>],
        _n: usize,
    ) -> SequentialEvidence {
        let all = streams.iter().map(|stream| &stream.evidence);
        SequentialRule::sum(model.classes(), all)
    }
}

impl<V: DecidesBy<R>, R: DecisionRule, W: Words, const K: usize> Several<V, R, W, K> {
    /// Joins a model and a rule; nothing is seen yet, all classes are equal.
    ///
    /// # Errors
    ///
    /// The rule's settings do not fit the model.
    pub fn new(model: Model<W>, settings: R::Settings) -> Result<Self, SetupError> {
        let constants = Constants::new(model, settings)?;
        Ok(Self {
            streams: core::array::from_fn(|_| StreamState::new(&constants.rule)),
            constants,
            decides_by: PhantomData,
        })
    }

    /// Posterior of each class after the last full block, by which a stream would decide;
    /// see [`crate::NaiveBayes::posteriors`].
    pub fn posteriors(&self, stream: usize) -> Posteriors {
        let Constants { model, rule } = &self.constants;
        let evidence = V::evidence(model, rule, &self.streams, stream);
        posteriors(model, rule, &evidence)
    }
}

impl<V: DecidesBy<R>, R: DecisionRule, W: Words, const K: usize> Streams for Several<V, R, W, K> {
    type Words = W;
    type Rule = R;

    fn constants(&self) -> &Constants<R, W> {
        &self.constants
    }

    #[inline]
    fn push_to(&mut self, stream: usize, codes: &[i32]) -> Result<Option<Decision>, WrongChannels> {
        let Constants { model, rule } = &self.constants;
        let Some(one) = self.streams.get_mut(stream) else {
            return Ok(None);
        };
        if one.push(model, codes, rule.interval())? {
            return Ok(V::end_of_block(model, rule, &mut self.streams, stream));
        }
        Ok(None)
    }

    #[inline]
    fn pass_to(&mut self, stream: usize, codes: &[i32]) -> Result<(), WrongChannels> {
        let stream = self.streams.get_mut(stream);
        stream.map_or(Ok(()), |stream| stream.pass(&self.constants.model, codes))
    }

    #[inline]
    fn touch_of(&self, stream: usize) -> u16 {
        self.streams.get(stream).map_or(0, |stream| stream.touch)
    }

    fn begin_touch(&mut self, stream: usize, number: u16) {
        if let Some(stream) = self.streams.get_mut(stream) {
            let Constants { model, rule } = &self.constants;
            stream.begin_touch(model, rule, number);
        }
    }

    fn interrupt_stream(&mut self, stream: usize) {
        if let Some(stream) = self.streams.get_mut(stream) {
            stream.interrupt::<W>();
        }
    }

    fn set_rule(&mut self, settings: R::Settings) -> Result<(), SetupError> {
        self.constants.set_rule(settings)
    }

    fn restart(&mut self) {
        for stream in &mut self.streams {
            *stream = StreamState::new(&self.constants.rule);
        }
    }
}
