//! The state of a module between ticks, and its start.

#[cfg(test)]
mod tests;

use core::ops::Range;

use heapless::Vec;
use serde::{Deserialize, Serialize};

use crate::gate::Gate;
use crate::list::listed;
use crate::muscle::History;
use crate::oscillator::Psi;
use crate::{MAX_OWN, MAX_SIDES, MAX_WHISKERS, Real, Voted};
use crate::{muscle, noise, oscillator};

/// Constants of the start of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Start<R: Real> {
    /// The sides, left first.
    pub sides: Vec<SideStart<R>, MAX_SIDES>,
    /// The whiskers, the left side's first.
    pub whiskers: Vec<WhiskerStart<R>, MAX_WHISKERS>,
}

/// The start of one side.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct SideStart<R: Real> {
    /// ψ in the form that the integrator keeps.
    pub oscillator: Psi<R>,
    /// Drive W.
    pub drive: R,
}

/// The start of one whisker.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct WhiskerStart<R: Real> {
    /// Its side, 0 or 1.
    pub side: u8,
    /// Nominal gain, g_nominal, 0 to 2.
    pub gain: R,
    /// Forces before the start.
    pub history: History<R>,
}

/// One side: its modulation by RCP.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Side<R: Real> {
    /// z (eq. 10), 0 to 1.
    pub z: Gate<R>,
    /// Drive W at the end of the last tick.
    pub(crate) drive: R,
}

/// One whisker: its muscle and its gain g.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WhiskerState<R: Real> {
    /// Its side, 0 or 1. A whisker of a side that the module does not have rests.
    pub side: u8,
    /// θ and the rest of the integrator's state.
    pub muscle: muscle::State<R>,
    /// How far contact lifts g above its nominal value (eqs. 12 and 13).
    pub lift: Gate<R>,
    pub(crate) nominal: Voted<R>,
}

/// State of a module.
#[derive(Debug, Clone)]
pub struct State<R: Real> {
    /// The oscillator of each side.
    pub oscillators: oscillator::State<R>,
    /// The sides, left first.
    pub sides: Vec<Side<R>, MAX_SIDES>,
    /// The whiskers, the left side's first.
    pub whiskers: Vec<WhiskerState<R>, MAX_OWN>,
    pub(crate) noise: noise::State<R>,
}

impl<R: Real> WhiskerState<R> {
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

impl<R: Real> State<R> {
    /// A module at its start. `seed` determines the noise.
    pub fn new(start: &Start<R>, seed: u64) -> Self {
        Self::of_some(start, 0..start.whiskers.len(), seed)
    }

    /// The same with only some of the whiskers; none where there are not so many.
    pub fn of_some(start: &Start<R>, whiskers: Range<usize>, seed: u64) -> Self {
        let whiskers = start.whiskers.get(whiskers).unwrap_or_default();
        let kept: Vec<Psi<R>, MAX_SIDES> = listed(start.sides.iter().map(|side| side.oscillator));
        Self {
            noise: noise::State::new(kept.len(), seed),
            oscillators: oscillator::State::new(kept),
            sides: listed(start.sides.iter().map(|start| Side {
                z: Gate::default(),
                drive: start.drive,
            })),
            whiskers: listed(whiskers.iter().map(|start| WhiskerState {
                side: start.side,
                muscle: muscle::State::new(start.history),
                lift: Gate::default(),
                nominal: Voted::new(start.gain),
            })),
        }
    }

    /// Protraction θ of every whisker, the left side's first; θ' = 100 θ + 50 degrees.
    #[inline]
    pub fn theta(&self) -> impl Iterator<Item = R> + '_ {
        self.whiskers.iter().map(|whisker| whisker.muscle.theta)
    }
}
