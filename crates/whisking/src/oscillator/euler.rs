//! The papers' integrator: forward Euler, with every right-hand side taken at
//! the state before the step. It keeps ψ itself.

use super::{OscillatorIntegrator, Psi, State, TAU_PERIODS, anew, is_sound, limited, pull};
use crate::Real;

/// Constants of forward Euler.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "bake", derive(databake::Bake), databake(path = whisking::oscillator))]
pub struct Euler<R: Real> {
    /// T/τ_r.
    pub relax: R::Fine,
    /// 2π f_W T.
    pub turn: R::Fine,
    /// T/τ_11; zero without coupling.
    pub couple: R::Coefficient,
}

impl<R: Real> Euler<R> {
    /// For `cycles` = f_W T whisks per tick.
    pub(crate) fn new(cycles: f64, coupling: bool) -> Self {
        let rate = cycles / TAU_PERIODS;
        Self {
            relax: R::fine(rate),
            turn: R::fine(core::f64::consts::TAU * cycles),
            couple: R::coefficient(if coupling { rate } else { 0.0 }),
        }
    }

    /// T dψ/dt of a side; `other` is ψ_1 of the other side.
    #[inline]
    fn rate(&self, [a, b]: Psi<R>, other: R) -> Psi<R> {
        let [x, y] = pull([a, b], self.relax);
        [
            x - b.times_fine(self.turn) + (other - a).times(self.couple),
            y + a.times_fine(self.turn),
        ]
    }

    #[inline]
    pub(super) fn increments<const S: usize>(&self, psi: &[Psi<R>; S]) -> [Psi<R>; S] {
        // A lone side is coupled to itself, which has no effect.
        core::array::from_fn(|side| self.rate(psi[side], psi[(side + 1) % S][0]))
    }
}

impl<R: Real> OscillatorIntegrator<R> for Euler<R> {
    #[inline]
    fn step<const S: usize>(&self, state: &mut State<R, S>, noise: Option<&[Psi<R>; S]>) {
        let mut change = self.increments(&state.kept);
        for side in 0..S {
            for k in 0..2 {
                if let Some(noise) = noise {
                    change[side][k] = change[side][k] + noise[side][k];
                }
                state.kept[side][k].accumulate(&mut state.carry[side][k], change[side][k]);
            }
        }
        if !is_sound(&state.kept) {
            *state = State::new(anew());
        }
        for (psi, carry) in state.kept.iter_mut().zip(&mut state.carry) {
            let within = limited(*psi);
            if within != *psi {
                (*psi, *carry) = (within, [R::Carry::default(); 2]);
            }
        }
    }
    #[inline]
    fn drives<const S: usize>(&self, state: &State<R, S>) -> [R; S] {
        state.kept.map(|[drive, _]| drive)
    }

    fn psi<const S: usize>(&self, state: &State<R, S>) -> [Psi<R>; S] {
        state.kept
    }
}

/// The field T dψ/dt in f64; `cycles` is f_W T.
pub(crate) fn field<const S: usize>(
    psi: &[Psi<f64>; S],
    cycles: f64,
    coupling: bool,
) -> [Psi<f64>; S] {
    Euler::new(cycles, coupling).increments(psi)
}
