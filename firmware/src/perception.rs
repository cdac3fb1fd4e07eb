//! What decides about what a module touches, or does not.

mod classifying;
mod codes;
mod deployed;

use crate::Event;
use crate::sensing::Reading;

pub use classifying::{Classifying, ClassifyingConfig, Sample, SampleClassifier, TakesRule};
pub use codes::{CodeClassifier, NotCodes, shifts};
pub use deployed::{Deployed, ModelLimits, ModelState, Refusal};

/// Decides from the readings of a module by the constants `C`, or does not.
pub trait Perception<R, C, const S: usize, const N: usize> {
    /// One tick: contact of each whisker and the readings it came from. `events` gets
    /// touches and decisions.
    fn step(
        &mut self,
        config: &C,
        contact: &[[R; N]; S],
        readings: &[[Reading; N]; S],
        events: &mut impl FnMut(Event),
    );

    /// The constants have changed between two ticks: what was made of them is made anew.
    fn retune(&mut self, config: &C);
}

/// No perception.
impl<R, const S: usize, const N: usize> Perception<R, (), S, N> for () {
    #[inline]
    fn step(
        &mut self,
        (): &(),
        _contact: &[[R; N]; S],
        _readings: &[[Reading; N]; S],
        _events: &mut impl FnMut(Event),
    ) {
    }

    fn retune(&mut self, (): &()) {}
}

/// Perception that lies elsewhere.
impl<R, C, P, const S: usize, const N: usize> Perception<R, C, S, N> for &mut P
where
    P: Perception<R, C, S, N>,
{
    #[inline]
    fn step(
        &mut self,
        config: &C,
        contact: &[[R; N]; S],
        readings: &[[Reading; N]; S],
        events: &mut impl FnMut(Event),
    ) {
        (**self).step(config, contact, readings, events);
    }

    fn retune(&mut self, config: &C) {
        (**self).retune(config);
    }
}

/// Perception that is there or not at run time, for simulations of any scene.
/// A configuration without the perception, or the reverse, decides nothing.
impl<R, C, P, const S: usize, const N: usize> Perception<R, Option<C>, S, N> for Option<P>
where
    P: Perception<R, C, S, N>,
{
    #[inline]
    fn step(
        &mut self,
        config: &Option<C>,
        contact: &[[R; N]; S],
        readings: &[[Reading; N]; S],
        events: &mut impl FnMut(Event),
    ) {
        if let (Some(perception), Some(config)) = (self, config) {
            perception.step(config, contact, readings, events);
        }
    }

    fn retune(&mut self, config: &Option<C>) {
        if let (Some(perception), Some(config)) = (self, config) {
            perception.retune(config);
        }
    }
}
