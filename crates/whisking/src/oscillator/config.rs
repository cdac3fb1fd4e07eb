//! The oscillators' integrator as a choice at run time.

use heapless::Vec;
use serde::{Deserialize, Serialize};

use super::{Euler, Exact, Psi, State};
use crate::{MAX_SIDES, Real};

/// An integrator chosen at run time, with its constants.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub enum Config<R: Real> {
    /// Forward Euler.
    Euler(Euler<R>),
    /// Exact parts in symmetric composition.
    Exact(Exact<R>),
}

impl<R: Real> Config<R> {
    /// One tick. `noise` is T P_i (eq. 5) of each side; each state is limited to ±1.5 afterwards.
    /// From a state that no tick leads to, NaN included, all sides begin again together.
    #[inline]
    pub fn step(&self, state: &mut State<R>, noise: Option<&[Psi<R>]>) {
        match self {
            Self::Euler(euler) if cfg!(feature = "euler") => euler.step(state, noise),
            Self::Exact(exact) if cfg!(feature = "exact") => exact.step(state, noise),
            // The program cannot compute it: the module rests.
            Self::Euler(_) | Self::Exact(_) => {}
        }
    }

    /// ψ_1 of every side, which drives its muscles, within ±1.5 to rounding; zero for a side
    /// that there is not.
    #[inline]
    pub fn drives(&self, state: &State<R>) -> [R; MAX_SIDES] {
        match self {
            Self::Euler(euler) if cfg!(feature = "euler") => euler.drives(state),
            Self::Exact(exact) if cfg!(feature = "exact") => exact.drives(state),
            Self::Euler(_) | Self::Exact(_) => [R::ZERO; MAX_SIDES],
        }
    }

    /// Whisks a tick in Q24, f_W T · 2^24, by the rate at which its radius relaxes: within
    /// 0.2 % and two units.
    pub fn cycles_q24(&self) -> i32 {
        let q24 = |share: R::Fine| R::ONE.times_fine(share).to_q24();
        match self {
            // T/τ_r = f_W T / 2.
            Self::Euler(euler) => 2 * q24(euler.relax),
            // x + x²/2 of x = 1 − exp(−T/τ_r), at most 1/16.
            Self::Exact(exact) => {
                let x = q24(exact.relax);
                let square = (i64::from(x) * i64::from(x)) >> 24;
                2 * x + square as i32
            }
        }
    }

    /// Phase of a side, 2⁻¹⁶ of a whisk from where protraction is driven most: its place on
    /// |ψ_1| + |ψ_2| = const., which runs with the angle of ψ to within 4.1 degrees. Of
    /// [`Exact`] it is half a tick behind. 0 for a side that there is not.
    #[inline]
    pub fn phase(&self, state: &State<R>, side: usize) -> u16 {
        let psi = match (self, state.kept.as_slice()) {
            (Self::Exact(_), [m, d]) if side == 0 => Some([m[0] + d[0], m[1] + d[1]]),
            (Self::Exact(_), [m, d]) if side == 1 => Some([m[0] - d[0], m[1] - d[1]]),
            (_, sides) => sides.get(side).copied(),
        };
        // Within ±3, that is 17 bits and a sign.
        let [first, second] = psi.unwrap_or([R::ZERO; 2]).map(|x| x.to_q24() >> 10);
        let around = first.wrapping_abs() + second.wrapping_abs();
        let quarter = (second << 14).checked_div(around).unwrap_or(0);
        let turn = if first < 0 {
            (1 << 15) - quarter
        } else {
            quarter
        };
        turn as u16
    }

    /// What a small difference of ψ of a side has become after `ticks`: it has turned with ψ. What
    /// pulls it to the circle and to the other side is left out: within `ticks` f_W T / 2 of it.
    pub fn aged(&self, difference: Psi<R>, ticks: u16) -> Psi<R> {
        let turned = |[x, y]: Psi<R>| match self {
            Self::Euler(euler) if cfg!(feature = "euler") => {
                [x - y.times_fine(euler.turn), y + x.times_fine(euler.turn)]
            }
            Self::Exact(exact) if cfg!(feature = "exact") => exact.turned([x, y]),
            Self::Euler(_) | Self::Exact(_) => [x, y],
        };
        (0..ticks).fold(difference, |psi, _| turned(psi))
    }

    /// Adds `difference` to ψ of a side; nothing to one that there is not.
    pub fn shift(&self, state: &mut State<R>, side: usize, difference: Psi<R>) {
        match self {
            Self::Euler(_) if cfg!(feature = "euler") => {
                if let Some([x, y]) = state.kept.get_mut(side) {
                    *x = *x + difference[0];
                    *y = *y + difference[1];
                }
            }
            Self::Exact(exact) if cfg!(feature = "exact") => exact.shift(state, side, difference),
            Self::Euler(_) | Self::Exact(_) => {}
        }
    }

    /// ψ of every side.
    pub fn psi(&self, state: &State<R>) -> Vec<Psi<R>, MAX_SIDES> {
        match self {
            Self::Euler(euler) if cfg!(feature = "euler") => euler.psi(state),
            Self::Exact(exact) if cfg!(feature = "exact") => exact.psi(state),
            Self::Euler(_) | Self::Exact(_) => Vec::new(),
        }
    }
}
