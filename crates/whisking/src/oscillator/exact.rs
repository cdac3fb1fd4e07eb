//! An integrator of exactly solved parts in symmetric composition.
//!
//! - *modes*: the mean of the sides, m = (ψ_l + ψ_r)/2, and half their
//!   difference, d = (ψ_l − ψ_r)/2. A lone side is its own mean.
//! - *L*: the linear part of the field. It does not mix the modes: the mean
//!   rotates, the difference rotates and decays (a 2 × 2 exponential).
//! - *R*: the radial relaxation of each side, r → 1 + (r − 1) exp(−T/τ_r).
//!
//! A tick is the symmetric product L½ R L½. Because the last half of L meets the first half of the
//! next tick, the integrator keeps χ = L½⁻¹ ψ, as modes: a tick takes it to R L χ, and ψ = L½ χ is
//! computed on demand. Without noise the limit cycle has radius one, to rounding, at any f_W T.

use heapless::Vec;
use serde::{Deserialize, Serialize};

use super::{Psi, Sides, State, TAU_PERIODS, again, is_sound, limited, of_sides, pull};
use crate::linalg::{Matrix, exponential, identity, scaled};
use crate::list::listed;
use crate::{MAX_SIDES, Real};

/// Constants of the structure-preserving step, as increments: factors near one
/// would cost formats with few digits several of them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Exact<R: Real> {
    /// The increment of a tick of L, exp(A T) − 1, of the mean (a rotation) and of
    /// the difference (rotation and decay).
    pub tick: [Turn<R>; 2],
    /// The same for half a tick.
    pub half: [Turn<R>; 2],
    /// The same for half a tick backwards.
    pub back: [Turn<R>; 2],
    /// What half a tick takes away from ψ_1 of the mean and of the difference.
    pub drive: [R::Row<2>; 2],
    /// 1 − exp(−T/τ_r).
    pub relax: R::Fine,
    /// Half of it.
    pub half_relax: R::Coefficient,
}

/// (x, y) → (−a x − c y, c x − b y), the increment of a rotation with decay.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Turn<R: Real> {
    /// a and b; their error shows in the radius.
    pub shrink: [R::Fine; 2],
    /// c; its error accumulates in the phase.
    pub cross: R::Fine,
}

#[inline]
fn sum<R: Real>(a: Psi<R>, b: Psi<R>) -> Psi<R> {
    [a[0] + b[0], a[1] + b[1]]
}

#[inline]
fn difference<R: Real>(a: Psi<R>, b: Psi<R>) -> Psi<R> {
    [a[0] - b[0], a[1] - b[1]]
}

/// The sides of `modes`, or twice the modes of sides.
#[inline]
fn crossed<R: Real, const S: usize>(modes: &[Psi<R>; S]) -> [Psi<R>; S] {
    let mut out = *modes;
    if let ([m, d], [left, right]) = (&modes[..], &mut out[..]) {
        (*left, *right) = (sum(*m, *d), difference(*m, *d));
    }
    out
}

#[inline]
fn modes<R: Real, const S: usize>(sides: &[Psi<R>; S]) -> [Psi<R>; S] {
    crossed(&sides.map(|psi| psi.map(|x| if S == 2 { x.halved() } else { x })))
}

#[inline]
fn dot<R: Real>(a: Psi<R>, b: Psi<R>) -> R {
    a[0] * b[0] + a[1] * b[1]
}

/// How far r² may be from 1 for the share (r − 1)/r by which a radius exceeds one to be a
/// polynomial in r² − 1: 1/16.
#[inline]
fn near_circle<R: Real>() -> R {
    R::ONE.halved().halved().halved().halved()
}

#[inline]
fn sums<R: Real, const S: usize>(a: &[Psi<R>; S], b: &[Psi<R>; S]) -> [Psi<R>; S] {
    let mut out = *a;
    for (a, b) in out.iter_mut().zip(b) {
        *a = sum(*a, *b);
    }
    out
}

/// The increment of every mode by L.
#[inline]
fn increments<R: Real, const S: usize>(turns: &[Turn<R>; 2], modes: &[Psi<R>; S]) -> [Psi<R>; S] {
    let mut out = *modes;
    for (x, turn) in out.iter_mut().zip(turns) {
        *x = turn.increment(*x);
    }
    out
}

impl<R: Real> Turn<R> {
    /// Of the matrix (−a, −c; c, −b).
    fn new([[a, _], [c, b]]: &Matrix<2>) -> Self {
        Self {
            shrink: [R::fine(-*a), R::fine(-*b)],
            cross: R::fine(*c),
        }
    }

    #[inline]
    fn increment(&self, [x, y]: Psi<R>) -> Psi<R> {
        [
            -y.times_fine(self.cross) - x.times_fine(self.shrink[0]),
            x.times_fine(self.cross) - y.times_fine(self.shrink[1]),
        ]
    }
}

/// L over `ticks` of a tick, on the mean and on the difference.
fn turns<R: Real>(cycles: f64, coupling: bool, ticks: f64) -> [Turn<R>; 2] {
    growths(cycles, coupling, ticks).map(|growth| Turn::new(&growth))
}

/// exp(A t) − 1 on the mean and on the difference.
fn growths(cycles: f64, coupling: bool, ticks: f64) -> [Matrix<2>; 2] {
    let omega = core::f64::consts::TAU * cycles;
    // Each side is drawn to the other, so their difference decays twice as fast.
    let couple = if coupling {
        2.0 * cycles / TAU_PERIODS
    } else {
        0.0
    };
    [0.0, couple].map(|couple| {
        let mut m = exponential(&scaled(&[[-couple, -omega], [omega, 0.0]], ticks));
        for (x, one) in m.iter_mut().flatten().zip(identity::<2>().iter().flatten()) {
            *x -= one;
        }
        m
    })
}

impl<R: Real, const S: usize> Sides<'_, R, S> {
    /// Adds `change`, and noise by sides, to the modes.
    #[inline]
    fn change(&mut self, change: &[Psi<R>; S], noise: Option<&[Psi<R>; S]>) {
        let mut change = *change;
        if let Some(noise) = noise {
            change = sums(&change, &modes(noise));
        }
        // Only the mean is a long sum: the difference of coupled sides decays.
        let mut modes = self.kept.iter_mut().zip(change);
        if let Some((mean, change)) = modes.next() {
            for ((x, carry), step) in mean.iter_mut().zip(&mut self.carry[0]).zip(change) {
                x.accumulate(carry, step);
            }
        }
        for (mode, change) in modes {
            *mode = sum(*mode, change);
        }
    }
}

impl<R: Real> Exact<R> {
    /// For `cycles` = f_W T whisks per tick.
    pub(crate) fn new(cycles: f64, coupling: bool) -> Self {
        let share = -libm::expm1(-cycles / TAU_PERIODS);
        Self {
            tick: turns(cycles, coupling, 1.0),
            half: turns(cycles, coupling, 0.5),
            drive: growths(cycles, coupling, 0.5).map(|[first, _]| R::row(first.map(|x| -x))),
            back: turns(cycles, coupling, -0.5),
            relax: R::fine(share),
            half_relax: R::coefficient(share / 2.0),
        }
    }

    /// The change by R at `modes` plus `linear`, if every side is near the circle; a state
    /// that is no number, or so large that its square wraps around, is not.
    ///
    /// The sides are m ± d, and their r² − 1 is e ± 2 m d with e = m² + d² − 1. Removing a share
    /// h_l of the left and h_r of the right side removes (h_l + h_r) m + (h_l − h_r) d from their
    /// sum, and the same with m and d exchanged from their difference.
    #[inline]
    fn near<const S: usize>(
        &self,
        modes: &[Psi<R>; S],
        linear: &[Psi<R>; S],
    ) -> Option<[Psi<R>; S]> {
        let mut change = *linear;
        if let ([m, d], [on_m, on_d]) = (&modes[..], &mut change[..]) {
            let same = dot(*m, *m) + dot(*d, *d) - R::ONE;
            let cross = dot(*m, *d);
            let cross = cross + cross;
            let near = (same.abs() + cross.abs()).is_within(near_circle());
            if !(near && R::multiplies(modes)) {
                return None;
            }
            let [left, right] = [same + cross, same - cross].map(R::one_minus_inv_sqrt);
            let (along, across) = (left + right, left - right);
            for k in 0..2 {
                on_m[k] = on_m[k] - self.half_pull(along, m[k], across, d[k]);
                on_d[k] = on_d[k] - self.half_pull(along, d[k], across, m[k]);
            }
        } else {
            for (psi, change) in modes.iter().zip(&mut change) {
                let e = dot(*psi, *psi) - R::ONE;
                if !(e.is_within(near_circle()) && R::multiplies(modes)) {
                    return None;
                }
                let along = e.one_minus_inv_sqrt();
                for k in 0..2 {
                    change[k] = change[k] - along.rough(psi[k]).times_fine(self.relax);
                }
            }
        }
        Some(change)
    }

    /// (a x + b y)/2 times the relaxation of a tick.
    #[inline]
    fn half_pull(&self, a: R, x: R, b: R, y: R) -> R {
        (a.rough(x) + b.rough(y)).times(self.half_relax)
    }

    /// The same step far from the circle, where ψ may also reach its limits.
    #[cold]
    fn far<const S: usize>(&self, mut sides: Sides<'_, R, S>, noise: Option<&[Psi<R>; S]>) {
        let linear = increments(&self.tick, sides.kept);
        let turned = sums(sides.kept, &linear);
        let pulls = crossed(&turned).map(|side| pull(side, self.relax));
        sides.change(&sums(&linear, &modes(&pulls)), noise);
        let psi = self.unlimited(sides.kept);
        let sound = is_sound(sides.kept) && is_sound(&psi);
        let within = if sound { psi.map(limited) } else { again() };
        // A NaN differs from all.
        if within != psi {
            let modes = modes(&within);
            sides.restart(sums(&modes, &increments(&self.back, &modes)));
        }
    }

    fn unlimited<const S: usize>(&self, kept: &[Psi<R>; S]) -> [Psi<R>; S] {
        crossed(&sums(kept, &increments(&self.half, kept)))
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
        let linear = increments(&self.tick, sides.kept);
        match self.near(&sums(sides.kept, &linear), &linear) {
            Some(change) => sides.change(&change, noise),
            None => self.far(sides, noise),
        }
    }

    /// See [`Config::drives`](super::Config::drives).
    #[inline]
    pub fn drives(&self, state: &State<R>) -> [R; MAX_SIDES] {
        let [first, second] = &self.drive;
        let now = |kept: Psi<R>, half| kept[0] - R::dot(kept, half);
        match *state.kept {
            [psi] => [now(psi, first), R::ZERO],
            [m, d] => {
                let (m, d) = (now(m, first), now(d, second));
                [m + d, m - d]
            }
            _ => [R::ZERO; MAX_SIDES],
        }
    }

    /// ψ a tick later, by what turns it alone.
    pub(super) fn turned(&self, psi: Psi<R>) -> Psi<R> {
        let [turn, _] = &self.tick;
        sum(psi, turn.increment(psi))
    }

    /// See [`Config::shift`](super::Config::shift).
    pub(super) fn shift(&self, state: &mut State<R>, side: usize, difference: Psi<R>) {
        // χ is linear in ψ.
        let kept = |mode: Psi<R>, back: &Turn<R>| sum(mode, back.increment(mode));
        let [first, second] = &self.back;
        match (state.kept.as_mut_slice(), side) {
            ([psi], 0) => *psi = sum(*psi, kept(difference, first)),
            ([m, d], 0 | 1) => {
                let half = difference.map(R::halved);
                *m = sum(*m, kept(half, first));
                let half = if side == 0 { half } else { half.map(|x| -x) };
                *d = sum(*d, kept(half, second));
            }
            _ => {}
        }
    }

    /// See [`Config::psi`](super::Config::psi).
    pub fn psi(&self, state: &State<R>) -> Vec<Psi<R>, MAX_SIDES> {
        // Rounding may lead slightly beyond a limit.
        match *state.kept {
            [psi] => listed(self.unlimited(&[psi]).map(limited)),
            [m, d] => listed(self.unlimited(&[m, d]).map(limited)),
            _ => Vec::new(),
        }
    }
}

/// χ = L½⁻¹ ψ by modes.
pub(crate) fn keep<const S: usize>(
    psi: &[Psi<f64>; S],
    cycles: f64,
    coupling: bool,
) -> [Psi<f64>; S] {
    let modes = modes(psi);
    sums(&modes, &increments(&turns(cycles, coupling, -0.5), &modes))
}
