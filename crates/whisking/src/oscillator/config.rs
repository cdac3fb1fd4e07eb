//! The oscillators' integrator as a choice at run time.

use super::{Euler, Exact, OscillatorIntegrator, Psi, State};
use crate::Real;

/// An integrator chosen at run time, with its constants.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "bake", derive(databake::Bake), databake(path = whisking::oscillator))]
pub enum Config<R: Real> {
    /// Forward Euler.
    Euler(Euler<R>),
    /// Exact parts in symmetric composition.
    Exact(Exact<R>),
}

impl<R: Real> OscillatorIntegrator<R> for Config<R> {
    #[inline]
    fn step<const S: usize>(&self, state: &mut State<R, S>, noise: Option<&[Psi<R>; S]>) {
        match self {
            Self::Euler(euler) => euler.step(state, noise),
            Self::Exact(exact) => exact.step(state, noise),
        }
    }

    #[inline]
    fn drives<const S: usize>(&self, state: &State<R, S>) -> [R; S] {
        match self {
            Self::Euler(euler) => euler.drives(state),
            Self::Exact(exact) => exact.drives(state),
        }
    }

    fn psi<const S: usize>(&self, state: &State<R, S>) -> [Psi<R>; S] {
        match self {
            Self::Euler(euler) => euler.psi(state),
            Self::Exact(exact) => exact.psi(state),
        }
    }
}
