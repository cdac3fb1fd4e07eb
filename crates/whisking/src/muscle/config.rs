//! The muscles' integrator as a choice at run time.

use super::{Euler, Exact, MuscleIntegrator, State};
use crate::Real;

/// An integrator chosen at run time, with its constants.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "bake", derive(databake::Bake), databake(path = whisking::muscle))]
pub enum Config<R: Real> {
    /// Forward Euler.
    Euler(Euler<R>),
    /// Exact linear part, fifth-order exponential multistep.
    Exact(Exact<R>),
}

impl<R: Real> MuscleIntegrator<R> for Config<R> {
    #[inline]
    fn step(&self, state: &mut State<R>, gain: R, before: R, after: R) {
        match self {
            Self::Euler(euler) => euler.step(state, gain, before, after),
            Self::Exact(exact) => exact.step(state, gain, before, after),
        }
    }
}
