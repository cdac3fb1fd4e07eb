//! The muscles' integrator as a choice at run time.

use serde::{Deserialize, Serialize};

use super::{Euler, Exact, State};
use crate::Real;

/// An integrator chosen at run time, with its constants.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub enum Config<R: Real> {
    /// Forward Euler.
    Euler(Euler<R>),
    /// Exact linear part, fifth-order exponential multistep.
    Exact(Exact<R>),
}

impl<R: Real> Config<R> {
    /// One tick of one whisker: `gain` is 1.45 (1 − z) g, 0 to 2.9; `before` and
    /// `after` are the drive W at the two ends of the tick.
    ///
    /// The force is between 0 and 1, and both integrators are bounded for bounded
    /// forces: with the drives of an oscillator from the start on, |θ| stays below
    /// 2.5 and the rest of the state below 5, at any f_W T and for any gains.
    #[inline]
    pub fn step(&self, state: &mut State<R>, gain: R, before: R, after: R) {
        match self {
            Self::Euler(euler) if cfg!(feature = "euler") => euler.step(state, gain, before),
            Self::Exact(exact) if cfg!(feature = "exact") => exact.step(state, gain, after),
            // The program cannot compute it: the whisker rests.
            Self::Euler(_) | Self::Exact(_) => {}
        }
    }
}
