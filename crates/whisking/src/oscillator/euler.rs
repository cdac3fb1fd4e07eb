//! The papers' integrator: forward Euler, with every right-hand side taken at
//! the state before the step. It keeps ψ itself.

use heapless::Vec;
use serde::{Deserialize, Serialize};

use super::{Psi, Sides, State, TAU_PERIODS, again, is_sound, limited, of_sides, pull};
use crate::{MAX_SIDES, Real};

/// Constants of forward Euler.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
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

    /// See [`Config::step`](super::Config::step).
    #[inline]
    pub fn step(&self, state: &mut State<R>, noise: Option<&[Psi<R>]>) {
        if let Some(sides) = state.sides::<2>() {
            self.step_sides(sides, of_sides(noise));
        } else if let Some(sides) = state.sides::<1>() {
            self.step_sides(sides, of_sides(noise));
        }
    }

    #[inline]
    fn step_sides<const S: usize>(&self, mut sides: Sides<'_, R, S>, noise: Option<&[Psi<R>; S]>) {
        let mut change = self.increments(sides.kept);
        for side in 0..S {
            for k in 0..2 {
                if let Some(noise) = noise {
                    change[side][k] = change[side][k] + noise[side][k];
                }
                sides.kept[side][k].accumulate(&mut sides.carry[side][k], change[side][k]);
            }
        }
        if !is_sound(sides.kept) {
            sides.restart(again());
        }
        for (psi, carry) in sides.kept.iter_mut().zip(sides.carry) {
            let within = limited(*psi);
            if within != *psi {
                (*psi, *carry) = (within, [R::Carry::default(); 2]);
            }
        }
    }

    /// See [`Config::drives`](super::Config::drives).
    #[inline]
    pub fn drives(&self, state: &State<R>) -> [R; MAX_SIDES] {
        match *state.kept {
            [[drive, _]] => [drive, R::ZERO],
            [[left, _], [right, _]] => [left, right],
            _ => [R::ZERO; MAX_SIDES],
        }
    }

    /// See [`Config::psi`](super::Config::psi).
    pub fn psi(&self, state: &State<R>) -> Vec<Psi<R>, MAX_SIDES> {
        state.kept.clone()
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
