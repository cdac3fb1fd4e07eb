//! Classifiers whose channels and classes are known only at run time, for
//! programs on a PC.
//!
//! One and two channels run the very code that runs on a board. Other numbers
//! of channels look up row by row in a loop over channels, and share all the
//! rest: sums are exact integers, so the results are the same to the bit.

use core::fmt;
use std::boxed::Box;
use std::vec::Vec;

use crate::decision::Decision;
use crate::error::SetupError;
use crate::format::MAX_CLASSES;
use crate::likelihoods::{Classes, Row, Supported, rows};
use crate::model::Model;
use crate::quantiser::Binner;
use crate::sequential::{SequentialRule, Threshold};
use crate::stationary::StationaryRule;
use crate::streaming::{self, Rule, State, Streaming};
use crate::window::WindowRule;

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

/// A classifier and its state.
pub trait Classifier {
    /// Takes one sample, a code a channel; see [`crate::Streaming::push`].
    ///
    /// # Errors
    ///
    /// The number of codes is not the model's number of channels.
    fn push(&mut self, codes: &[i32]) -> Result<Option<Decision>, WrongChannels>;

    /// The end of a whisk or recording; see [`crate::Streaming::finish`].
    fn finish(&mut self) -> Option<Decision>;

    /// Forgets all evidence.
    fn reset(&mut self);

    /// Posterior of each class after the last full block.
    fn posteriors(&self) -> Vec<f64>;
}

/// A sequential classifier; see [`crate::Sequential`].
///
/// # Errors
///
/// None for a parsed model.
pub fn sequential<'m>(
    model: &Model<'m>,
    threshold: Threshold,
) -> Result<Box<dyn Classifier + 'm>, SetupError> {
    SequentialRule::new(model, threshold).boxed(model)
}

/// A classifier by fixed windows; see [`crate::Window`].
///
/// # Errors
///
/// The window is zero or not a multiple of the model's block.
pub fn window<'m>(model: &Model<'m>, window: u32) -> Result<Box<dyn Classifier + 'm>, SetupError> {
    WindowRule::new(model, window)?.boxed(model)
}

/// A whisk-by-whisk classifier; see [`crate::Stationary`].
///
/// # Errors
///
/// None for a parsed model.
pub fn stationary<'m>(model: &Model<'m>) -> Result<Box<dyn Classifier + 'm>, SetupError> {
    StationaryRule::new(model).boxed(model)
}

/// A rule for any number of classes, joined with a model of some number.
trait AnyRule {
    fn boxed<'m>(self, model: &Model<'m>) -> Result<Box<dyn Classifier + 'm>, SetupError>;
}

macro_rules! any_rule {
    ($($rule:ty),*) => {$(
        impl AnyRule for $rule {
            fn boxed<'m>(
                self,
                model: &Model<'m>,
            ) -> Result<Box<dyn Classifier + 'm>, SetupError> {
                any_rule!(@classes self, model,
                    2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29
                    30 31 32)
            }
        }
    )*};
    (@classes $rule:ident, $model:ident, $($k:literal)*) => {
        match $model.classes() {
            $($k => of_classes::<_, $k>($rule, $model),)*
            // No parsed model comes here.
            model => Err(SetupError::Classes { model, classifier: MAX_CLASSES }),
        }
    };
}
any_rule!(SequentialRule, WindowRule, StationaryRule);

fn of_classes<'m, R: Rule<K> + 'm, const K: usize>(
    rule: R,
    model: &Model<'m>,
) -> Result<Box<dyn Classifier + 'm>, SetupError>
where
    Classes<K>: Supported,
{
    Ok(match model.channels() {
        1 => Box::new(Fixed::<R, 1, K>::new(rule, model)?),
        2 => Box::new(Fixed::<R, 2, K>::new(rule, model)?),
        _ => Box::new(Wide::<R, K>::new(rule, model)?),
    })
}

/// The code of a board, with its state beside it.
struct Fixed<'m, R: Rule<K>, const C: usize, const K: usize>
where
    Classes<K>: Supported,
{
    streaming: Streaming<'m, R, C, K>,
    state: State<R::Evidence, K>,
}

impl<'m, R: Rule<K>, const C: usize, const K: usize> Fixed<'m, R, C, K>
where
    Classes<K>: Supported,
{
    fn new(rule: R, model: &Model<'m>) -> Result<Self, SetupError> {
        let streaming = Streaming::with_rule(model, rule)?;
        let state = streaming.state();
        Ok(Self { streaming, state })
    }
}

impl<R: Rule<K>, const C: usize, const K: usize> Classifier for Fixed<'_, R, C, K>
where
    Classes<K>: Supported,
{
    fn push(&mut self, codes: &[i32]) -> Result<Option<Decision>, WrongChannels> {
        let codes = codes.try_into().map_err(|_| WrongChannels {
            expected: C,
            found: codes.len(),
        })?;
        Ok(self.streaming.push(&mut self.state, codes))
    }

    fn finish(&mut self) -> Option<Decision> {
        self.streaming.finish(&mut self.state)
    }

    fn reset(&mut self) {
        self.streaming.reset(&mut self.state);
    }

    fn posteriors(&self) -> Vec<f64> {
        from_q32(&self.streaming.posteriors(&self.state))
    }
}

/// Any number of channels.
struct Wide<'m, R: Rule<K>, const K: usize>
where
    Classes<K>: Supported,
{
    rule: R,
    state: State<R::Evidence, K>,
    binners: Vec<Binner>,
    bins: usize,
    table: &'m [Row<K>],
}

impl<'m, R: Rule<K>, const K: usize> Wide<'m, R, K>
where
    Classes<K>: Supported,
{
    fn new(rule: R, model: &Model<'m>) -> Result<Self, SetupError> {
        let bins = model.bins();
        let binners = (0..model.channels())
            .map(|c| model.quantiser(c)?.binner(bins).ok())
            .collect::<Option<_>>()
            .ok_or(SetupError::Table)?;
        Ok(Self {
            state: streaming::start(&rule),
            rule,
            binners,
            bins,
            table: rows::<Row<K>, K>(model)?,
        })
    }
}

impl<R: Rule<K>, const K: usize> Classifier for Wide<'_, R, K>
where
    Classes<K>: Supported,
{
    fn push(&mut self, codes: &[i32]) -> Result<Option<Decision>, WrongChannels> {
        let expected = self.binners.len();
        let found = codes.len();
        if found != expected {
            return Err(WrongChannels { expected, found });
        }
        for (channel, (binner, &code)) in self.binners.iter().zip(codes).enumerate() {
            let row = binner.bin(code, self.bins) * expected + channel;
            if let Some(row) = self.table.get(row) {
                self.state.sums_mut().add([row]);
            }
        }
        Ok(streaming::count(&self.rule, &mut self.state))
    }

    fn finish(&mut self) -> Option<Decision> {
        streaming::finish(&self.rule, &mut self.state)
    }

    fn reset(&mut self) {
        self.state = streaming::start(&self.rule);
    }

    fn posteriors(&self) -> Vec<f64> {
        from_q32(&streaming::posteriors(&self.rule, &self.state))
    }
}

fn from_q32(posteriors: &[u32]) -> Vec<f64> {
    let unit = 1.0 / 4_294_967_296.0;
    posteriors.iter().map(|&p| f64::from(p) * unit).collect()
}
