//! The papers' integrator: forward Euler, with θ, v and the force taken at the
//! state before the step.

use serde::{Deserialize, Serialize};

use super::{DAMPING, State, force, pace};
use crate::Real;

/// Constants of forward Euler.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Euler<R: Real> {
    /// h = ω_n T.
    pub spring: R::Coefficient,
    /// 4 h.
    pub damping: R::Coefficient,
}

impl<R: Real> Euler<R> {
    /// For `cycles` = f_W T whisks per tick.
    pub(crate) fn new(cycles: f64) -> Self {
        Self {
            spring: R::coefficient(pace(cycles)),
            damping: R::coefficient(DAMPING * pace(cycles)),
        }
    }

    /// One tick with the gain of [`Config::step`](super::Config::step) and the drive W at its
    /// beginning.
    ///
    /// θ and v are limited to ±2, because large steps let them grow. No sensible
    /// input reaches that: the static solution at full drive is 1.015.
    #[inline]
    pub fn step(&self, state: &mut State<R>, gain: R, drive: R) {
        let push = gain * force(drive, state.theta);
        let [velocity, _] = state.kept;
        let limited = |x: R| x.clamp(-R::TWO, R::TWO);
        let pull = (push - state.theta).times(self.spring);
        // Within ±6 in fixed point, where a product is within ±4 and the damping
        // opposes the velocity.
        let next = velocity + pull - velocity.times(self.damping);
        state
            .theta
            .accumulate(&mut state.carry, velocity.times(self.spring));
        let within = limited(state.theta);
        if within != state.theta {
            state.theta = within;
            state.carry = R::Carry::default();
        }
        state.kept = [limited(next), R::ZERO];
    }
}
