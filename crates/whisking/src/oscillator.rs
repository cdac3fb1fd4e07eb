//! The two coupled oscillators (BIOTACT eqs. 1 to 5).
//!
//! In Cartesian form dψ_i/dt = ((1 − r)/(τ_r r)) ψ_i + ω J ψ_i + (ψ_j1 − ψ_i1, 0)/τ_11 with ω = 2π
//! f_W, J = (0, −1; 1, 0) and τ_r = τ_11 = 2 T_W, which needs no angle, sine or cosine in the tick.
//! At the origin, where eq. 3 has no direction, the radial force pushes along +ψ_1.
//!
//! There are two integrators: [`Euler`] is the papers', step for step; [`Exact`]
//! composes parts that are each solved exactly.

mod config;
mod euler;
mod exact;
#[cfg(test)]
mod tests;

pub use config::Config;
pub use euler::Euler;
pub(crate) use euler::field;
pub(crate) use exact::keep;
pub use exact::{Exact, Turn};

use heapless::Vec;

use crate::{MAX_SIDES, Real};

/// ψ of one side: drive state and recovery state.
pub type Psi<R> = [R; 2];

/// Limit ψ_lim of each state of an oscillator (BIOTACT section III-B).
pub const PSI_LIMIT: f64 = 1.5;

/// Radial and coupling time constants in whisk periods, τ_r/T_W = τ_11/T_W = 2.
const TAU_PERIODS: f64 = 2.0;

/// The oscillators of all sides.
#[derive(Debug, Clone, PartialEq)]
pub struct State<R: Real> {
    /// ψ in the form that the integrator keeps, of each side.
    pub(crate) kept: Vec<Psi<R>, MAX_SIDES>,
    /// Rounding errors of its sums.
    pub(crate) carry: [[R::Carry; 2]; MAX_SIDES],
}

/// The oscillators of a module of `S` sides: an integrator is written once for both numbers of
/// sides, and compiled for each, so that a lone side costs no more than it must.
struct Sides<'a, R: Real, const S: usize> {
    kept: &'a mut [Psi<R>; S],
    carry: &'a mut [[R::Carry; 2]; S],
}

impl<R: Real> State<R> {
    /// From [`SideStart::oscillator`](crate::SideStart::oscillator) of each side: ψ itself for
    /// [`Euler`], the modes half a tick earlier for [`Exact`].
    pub fn new(kept: Vec<Psi<R>, MAX_SIDES>) -> Self {
        Self {
            kept,
            carry: [[R::Carry::default(); 2]; MAX_SIDES],
        }
    }

    #[inline]
    fn sides<const S: usize>(&mut self) -> Option<Sides<'_, R, S>> {
        Some(Sides {
            kept: self.kept.as_mut_slice().try_into().ok()?,
            carry: self.carry.first_chunk_mut()?,
        })
    }
}

impl<R: Real, const S: usize> Sides<'_, R, S> {
    /// Goes on from `kept`, without rounding errors.
    #[inline]
    fn restart(&mut self, kept: [Psi<R>; S]) {
        *self.kept = kept;
        *self.carry = [[R::Carry::default(); 2]; S];
    }
}

#[inline]
fn of_sides<R: Real, const S: usize>(noise: Option<&[Psi<R>]>) -> Option<&[Psi<R>; S]> {
    noise?.first_chunk()
}

/// [`PSI_LIMIT`] in the number format of the tick.
#[inline]
fn psi_limit<R: Real>() -> R {
    R::ONE + R::ONE.halved()
}

/// Where all sides begin again together, on the circle.
#[inline]
fn again<R: Real, const S: usize>() -> [Psi<R>; S] {
    [[R::ONE, R::ZERO]; S]
}

/// Whether a tick can have led there, within ±4: noise may lead beyond the limit, though not
/// so far. Otherwise bits were flipped.
#[inline]
fn is_sound<R: Real>(kept: &[Psi<R>]) -> bool {
    let mut all = kept.iter().flatten();
    all.all(|x| x.is_within(R::TWO + R::TWO))
}

#[inline]
fn limited<R: Real>(psi: Psi<R>) -> Psi<R> {
    psi.map(|x| x.clamp(-psi_limit::<R>(), psi_limit()))
}

/// `share` of the way to the unit circle; along +ψ_1 at the origin.
#[inline]
fn pull<R: Real>([a, b]: Psi<R>, share: R::Fine) -> Psi<R> {
    match R::unit(a, b) {
        Some([x, y]) => [(x - a).times_fine(share), (y - b).times_fine(share)],
        None => [R::ONE.times_fine(share), R::ZERO],
    }
}
