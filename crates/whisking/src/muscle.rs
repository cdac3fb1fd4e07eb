//! The muscle and mass of one whisker (BIOTACT eqs. 6 to 8).
//!
//! m d²θ/dt² = q W − k θ − ν dθ/dt with q = 1.45 (1 − z) g exp(−θ²), k = 1, m = T_W²/100 and
//! ν = 4 √(k m): natural frequency ω_n = 10 f_W rad/s, damping ratio 2. With f = W exp(−θ²), the
//! force per gain a = 1.45 (1 − z) g, and v = (dθ/dt)/ω_n, the equations per tick are θ' = h v,
//! v' = h (a f − θ − 4 v) with h = ω_n T: linear in (θ, v) with input a f, and every state is near
//! one.
//!
//! There are two integrators: [`Euler`] is the papers', step for step; [`Exact`]
//! propagates the linear part exactly.

mod euler;
mod exact;
#[cfg(test)]
mod tests;

pub use euler::Euler;
pub use exact::{Exact, Lag};

use serde::{Deserialize, Serialize};

use crate::Real;

/// Peak of the muscle gain (eq. 8).
pub const PEAK_GAIN: f64 = 1.45;
/// ω_n/f_W = √(k/m)/f_W.
const STIFFNESS: f64 = 10.0;
/// ν/√(k m).
const DAMPING: f64 = 4.0;

/// f at the last tick and its backward differences; [`Euler`] does not use them.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct History<R> {
    /// f, ∇f, ∇²f, ∇³f.
    pub force: [R; 4],
}

/// θ of one whisker and the rest of its integrator's state.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct State<R: Real> {
    /// Protraction θ; θ' = 100 θ + 50 degrees.
    pub theta: R,
    /// v and 0 with [`Euler`], the slow and the fast lag with [`Exact`].
    pub(crate) kept: [R; 2],
    pub(crate) carry: R::Carry,
    pub(crate) history: History<R>,
}

/// Drive W = (tanh 2ψ_1 + 1)/2 (eq. 6), 0 to 1, for |ψ_1| ≤ 1.5; error 2e-7 in
/// f32, 6e-7 in [`Fix`](crate::Fix).
#[inline]
pub fn drive<R: Real>(psi: R) -> R {
    R::ONE.halved() + psi.half_tanh()
}

/// Force f = W exp(−θ²) (eq. 8) of `drive` W: contraction weakens a muscle.
#[inline]
pub fn force<R: Real>(drive: R, theta: R) -> R {
    drive * theta.exp_neg_square()
}

/// h = ω_n T for `cycles` = f_W T.
pub(crate) fn pace(cycles: f64) -> f64 {
    STIFFNESS * cycles
}

/// T dv/dt at `theta` and `velocity` under the force `push` = a f.
pub(crate) fn acceleration(cycles: f64, [theta, velocity]: [f64; 2], push: f64) -> f64 {
    pace(cycles) * (push - theta - DAMPING * velocity)
}

impl<R: Real> State<R> {
    /// At rest, with the forces before the start.
    pub fn new(history: History<R>) -> Self {
        Self {
            history,
            ..Self::default()
        }
    }

    /// The integrator's state beside θ: v and 0 with [`Euler`], the slow and the
    /// fast lag with [`Exact`]. For checks of its bounds.
    pub const fn kept(&self) -> [R; 2] {
        self.kept
    }
}

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
