//! An integrator that propagates the linear part exactly, and the force by an
//! exponential multistep method.
//!
//! With damping ratio 2 both poles are real, −(2 ∓ √3) ω_n, and the muscle is the weighted sum of
//! two *lags* that follow the same push a f, a slow one and a fast one: dy/dt = λ (a f − y),
//! θ = y_slow + c (y_slow − y_fast) with c = 1/√3 − 1/2. A lag needs no matrix, its equilibrium is
//! the push however its constants are rounded, and because 0 ≤ f ≤ 1 it cannot grow.
//!
//! f is interpolated by the quartic through its last values: an exponential Adams method of fifth
//! order, predicted and corrected once, with one exponential and one drive per tick. The gain is
//! applied after the differences are taken, so that a jump of z or g does not enter the history.

use serde::{Deserialize, Serialize};

use super::{State, pace};
use crate::Real;
use crate::linalg::{Matrix, exponential};

/// λ/ω_n of the slow and of the fast lag, 2 ∓ √3.
const RATES: [f64; 2] = [0.267_949_192_431_122_7, 3.732_050_807_568_877];

/// Constants of the method.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Exact<R: Real> {
    /// The slow lag and the fast one.
    pub lags: [Lag<R>; 2],
    /// c, the weight of y_slow − y_fast in θ.
    pub lead: R::Coefficient,
}

/// A first-order lag over one tick, as increments.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Lag<R: Real> {
    /// 1 − exp(−λ T), the fraction of the way to a f.
    pub decay: R::Fine,
    /// Weights of ∇f, ∇²f and ∇³f (predictor).
    pub predict: R::Row<3>,
    /// Weight of ∇⁴f at the new end (corrector).
    pub correct: R::Coefficient,
}

impl<R: Real> Lag<R> {
    /// For λ T = `rate`.
    pub(super) fn new(rate: f64) -> Self {
        // The lag driven by a chain of integrators: the exponential holds the
        // decay and, beside it, the response to each power s^k/k! of time.
        let mut a: Matrix<6> = [[0.0; 6]; 6];
        a[0][..2].copy_from_slice(&[-rate, rate]);
        for k in 1..5 {
            a[k][k + 1] = 1.0;
        }
        let [response, ..] = exponential(&a);
        let [_, _, power1, power2, power3, power4] = response;
        // Newton's basis s, s(s+1)/2, s(s+1)(s+2)/6, s(s+1)(s+2)(s+3)/24 in powers s^k/k!.
        Self {
            decay: R::fine(-libm::expm1(-rate)),
            predict: R::row([
                power1,
                power2 + power1 / 2.0,
                power3 + power2 + power1 / 3.0,
            ]),
            correct: R::coefficient(power4 + 1.5 * power3 + 11.0 / 12.0 * power2 + power1 / 4.0),
        }
    }
}

impl<R: Real> Exact<R> {
    /// For `cycles` = f_W T whisks per tick.
    pub(crate) fn new(cycles: f64) -> Self {
        let [slow, fast] = RATES;
        Self {
            lags: RATES.map(|rate| Lag::new(rate * pace(cycles))),
            lead: R::coefficient(slow / (fast - slow)),
        }
    }

    #[inline]
    fn theta(&self, [slow, fast]: [R; 2]) -> R {
        slow + (slow - fast).times(self.lead)
    }

    /// One tick with the gain of [`Config::step`](super::Config::step) and the drive W at its end.
    #[inline]
    pub fn step(&self, state: &mut State<R>, gain: R, drive: R) {
        let [f, d1, d2, d3] = state.history.force;
        let push = gain * f;
        let way = [0, 1].map(|i| (push - state.kept[i]).times_fine(self.lags[i].decay));
        let bends = [0, 1].map(|i| R::dot([d1, d2, d3], &self.lags[i].predict));
        let predicted = self.theta([0, 1].map(|i| state.kept[i] + (way[i] + bends[i].rough(gain))));
        let force = super::force(drive, predicted);
        let n1 = force - f;
        // With fewer than ten ticks per whisk a jump of the gain can make these as large as eight.
        let n2 = (n1 - d1).within_half();
        let n3 = (n2 - d2).within_half();
        // The weight comes before the gain: the difference alone may be large.
        let n4 = (n3 - d3).within_half();
        let [slow, fast] =
            [0, 1].map(|i| way[i] + (bends[i] + n4.times(self.lags[i].correct)).rough(gain));
        let [slow_lag, fast_lag] = &mut state.kept;
        // Only the slow lag sums over many ticks.
        slow_lag.accumulate(&mut state.carry, slow);
        *fast_lag = *fast_lag + fast;
        state.theta = self.theta(state.kept);
        // More than |θ| ever is.
        if !state.theta.is_within(R::TWO + R::ONE.halved()) {
            // Its bits were flipped. The history is bounded, and forgets by itself.
            *state = State::default();
        }
        state.history.force = [force, n1, n2, n3];
    }
}
