//! The state of a module between ticks, and its start.

#[cfg(test)]
mod tests;

use crate::gate::Gate;
use crate::muscle::{self, History};
use crate::oscillator::{self, Psi};
use crate::{Real, Voted, noise};

/// Constants of the start of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "bake", derive(databake::Bake), databake(path = whisking))]
pub struct Start<R, const S: usize, const N: usize> {
    /// ψ of each side in the form that the integrator keeps.
    pub oscillators: [Psi<R>; S],
    /// Drive W of each side.
    pub drive: [R; S],
    /// Nominal gain of each whisker, g_nominal, 0 to 2.
    pub gain: [[R; N]; S],
    /// Forces before the start, of each whisker.
    pub history: [[History<R>; N]; S],
}

/// One whisker: its muscle and its gain g.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Whisker<R: Real> {
    /// θ and the rest of the integrator's state.
    pub muscle: muscle::State<R>,
    /// How far contact lifts g above its nominal value (eqs. 12 and 13).
    pub lift: Gate<R>,
    pub(crate) nominal: Voted<R>,
}

/// State of a module of `S` sides (1 or 2) with `N` whiskers each.
#[derive(Debug, Clone)]
pub struct State<R: Real, const S: usize, const N: usize> {
    /// The oscillator of each side.
    pub oscillators: oscillator::State<R, S>,
    /// z of each side (eq. 10), 0 to 1.
    pub z: [Gate<R>; S],
    /// The whiskers of each side.
    pub whiskers: [[Whisker<R>; N]; S],
    pub(crate) drive: [R; S],
    pub(crate) noise: noise::State<R, S>,
}

impl<R: Real> Whisker<R> {
    /// Nominal value of g, 0 to 2; 1 should all that is kept of it be lost.
    #[inline]
    pub fn nominal(&self) -> R {
        self.nominal.get().unwrap_or(R::ONE)
    }

    /// g of eqs. 12 and 13, 0 to 2.
    pub fn gain(&self) -> f64 {
        self.nominal().to_f64() + self.lift.value.to_f64()
    }

    /// Sets the nominal value of g, limited to 0..=2; what contact adds is
    /// limited so that g stays there too.
    pub fn set_nominal(&mut self, nominal: R) {
        let nominal = nominal.clamp(R::ZERO, R::TWO);
        self.nominal = Voted::new(nominal);
        let room = R::TWO - nominal;
        self.lift.value = self.lift.value.clamp(R::ZERO, room);
        self.lift.mean = self.lift.mean.clamp(R::ZERO, room);
    }
}

impl<R: Real, const S: usize, const N: usize> State<R, S, N> {
    /// A module at its start. `seed` determines the noise.
    pub fn new(start: &Start<R, S, N>, seed: u64) -> Self {
        Self {
            oscillators: oscillator::State::new(start.oscillators),
            z: [Gate::default(); S],
            whiskers: core::array::from_fn(|side| {
                core::array::from_fn(|w| Whisker {
                    muscle: muscle::State::new(start.history[side][w]),
                    lift: Gate::default(),
                    nominal: Voted::new(start.gain[side][w]),
                })
            }),
            drive: start.drive,
            noise: noise::State::new(seed),
        }
    }

    /// Protraction θ of every whisker; θ' = 100 θ + 50 degrees.
    pub fn theta(&self) -> [[R; N]; S] {
        self.whiskers
            .each_ref()
            .map(|side| side.each_ref().map(|whisker| whisker.muscle.theta))
    }
}
