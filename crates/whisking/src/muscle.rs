//! The muscle and mass of one whisker (BIOTACT eqs. 6 to 8).
//!
//! m d²θ/dt² = q W − k θ − ν dθ/dt with q = 1.45 (1 − z) g exp(−θ²), k = 1,
//! m = T_W²/100 and ν = 4 √(k m): natural frequency 10 f_W rad/s, damping
//! ratio 2. With f = W exp(−θ²), the force per gain a = 1.45 (1 − z) g, the
//! equation is linear in (θ, δ = T dθ/dt) with input a f.
//!
//! [`Exact`] propagates the linear part exactly and takes f as the cubic
//! through its last values: an exponential Adams method of fourth order,
//! predicted and corrected once, so one exponential and one drive a tick.
//! The gain multiplies after the differences are taken, so that a jump of z or
//! g does not enter the history.

use crate::Real;
use crate::linalg::{Matrix, exponential};

/// Peak of the muscle gain (eq. 8).
pub const PEAK_GAIN: f64 = 1.45;
/// ω_n/f_W = √(k/m)/f_W.
const STIFFNESS: f64 = 10.0;
/// ν/√(k m).
const DAMPING: f64 = 4.0;

/// Which integrator steps the muscles, with its constants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Config<R> {
    /// Forward Euler.
    Euler(Euler<R>),
    /// Exact linear part, fourth-order exponential multistep.
    Exact(Exact<R>),
}

/// Forward Euler: θ, δ and the force at the state before the step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Euler<R> {
    /// T² k/m.
    pub spring: R,
    /// T ν/m.
    pub damping: R,
}

/// Exact linear propagator and multistep weights; row 0 gives the increment of
/// θ, row 1 that of δ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exact<R> {
    /// exp(A) − 1 on (θ, δ).
    pub linear: [[R; 2]; 2],
    /// Weights of f, ∇f, ∇²f (predictor).
    pub predict: [[R; 3]; 2],
    /// Weight of ∇³f at the new end (corrector).
    pub correct: [R; 2],
}

/// f at the last tick and its backward differences; unused by Euler.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct History<R> {
    /// f, ∇f, ∇²f.
    pub force: [R; 3],
}

/// (θ, δ) of one whisker and what its integrator remembers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct State<R> {
    /// Protraction θ; θ' = 100 θ + 50 degrees.
    pub theta: R,
    /// T dθ/dt.
    pub delta: R,
    /// Past forces.
    pub history: History<R>,
}

/// T² k/m and T ν/m for `cycles` = f_W T.
pub(crate) fn rates(cycles: f64) -> [f64; 2] {
    let omega = STIFFNESS * cycles;
    [omega * omega, DAMPING * omega]
}

impl<R: Real> Euler<R> {
    pub(crate) fn new(cycles: f64) -> Self {
        let [spring, damping] = rates(cycles).map(R::from_f64);
        Self { spring, damping }
    }

    #[inline]
    fn step(&self, state: &mut State<R>, gain: R, drive: R) {
        let force = gain * drive * state.theta.exp_neg_square();
        let delta = state.delta;
        state.delta += self.spring * (force - state.theta) - self.damping * delta;
        state.theta += delta;
    }
}

impl<R: Real> Exact<R> {
    pub(crate) fn new(cycles: f64) -> Self {
        let [spring, damping] = rates(cycles);
        // (θ, δ) driven by a chain of integrators: the exponential holds the
        // propagator and, beside it, the response to each power s^k/k! of time.
        let mut a: Matrix<6> = [[0.0; 6]; 6];
        a[0][1] = 1.0;
        a[1][0] = -spring;
        a[1][1] = -damping;
        a[1][2] = spring;
        for k in 2..5 {
            a[k][k + 1] = 1.0;
        }
        let e = exponential(&a);
        let row = |i: usize| {
            let [power0, power1, power2, power3] = [e[i][2], e[i][3], e[i][4], e[i][5]];
            // Newton's basis 1, s, s(s+1)/2, s(s+1)(s+2)/6 in powers s^k/k!.
            [
                power0,
                power1,
                power2 + power1 / 2.0,
                power3 + power2 + power1 / 3.0,
            ]
        };
        let weights = [row(0), row(1)];
        Self {
            linear: [[e[0][0] - 1.0, e[0][1]], [e[1][0], e[1][1] - 1.0]]
                .map(|row| row.map(R::from_f64)),
            predict: weights.map(|w| [w[0], w[1], w[2]].map(R::from_f64)),
            correct: weights.map(|w| R::from_f64(w[3])),
        }
    }

    #[inline]
    fn step(&self, state: &mut State<R>, gain: R, drive: R) {
        let [f, d1, d2] = state.history.force;
        let mut change = [R::ZERO; 2];
        for (i, c) in change.iter_mut().enumerate() {
            let [w0, w1, w2] = self.predict[i];
            let [l0, l1] = self.linear[i];
            *c = l0 * state.theta + l1 * state.delta + gain * (w0 * f + w1 * d1 + w2 * d2);
        }
        let force = drive * (state.theta + change[0]).exp_neg_square();
        let n1 = force - f;
        let n2 = n1 - d1;
        let correction = gain * (n2 - d2);
        state.theta += change[0] + self.correct[0] * correction;
        state.delta += change[1] + self.correct[1] * correction;
        state.history.force = [force, n1, n2];
    }
}

impl<R: Real> Config<R> {
    /// One tick of one whisker: `gain` is 1.45 (1 − z) g, `before` and `after`
    /// the drive W at the two ends of the tick.
    ///
    /// θ and δ are held within ±2, which no sane input reaches (the static
    /// solution at full drive is 1.015), so that no input can make them grow.
    #[inline]
    pub fn step(&self, state: &mut State<R>, gain: R, before: R, after: R) {
        match self {
            Self::Euler(euler) => euler.step(state, gain, before),
            Self::Exact(exact) => exact.step(state, gain, after),
        }
        let limit = R::ONE + R::ONE;
        state.theta = state.theta.clamp(-limit, limit);
        state.delta = state.delta.clamp(-limit, limit);
    }
}

#[cfg(test)]
mod tests {
    use super::{Config, Euler, Exact, State};

    #[test]
    fn a_constant_force_is_answered_as_the_closed_form_says() {
        // Without the loss of force (tiny gain) the answer to a step is
        // 1 + (p2 e^{p1 t} − p1 e^{p2 t})/(p1 − p2), p = −ω(2 ∓ √3).
        let cycles = 1.25e-2;
        let config = Config::Exact(Exact::new(cycles));
        let mut state = State::default();
        state.history.force = [1.0, 0.0, 0.0];
        let gain = 1e-6;
        for n in 1..=80 {
            config.step(&mut state, gain, 1.0, 1.0);
            let t = 10.0 * cycles * f64::from(n);
            let (p1, p2) = (-(2.0 - 3.0_f64.sqrt()), -(2.0 + 3.0_f64.sqrt()));
            let expected = 1.0 + (p2 * (p1 * t).exp() - p1 * (p2 * t).exp()) / (p1 - p2);
            assert!((state.theta / gain - expected).abs() < 1e-9, "{n}");
        }
    }

    #[test]
    fn the_static_solution_at_full_drive_is_just_above_one() {
        // On the limit cycle the drive is at most (tanh 2 + 1)/2; θ exp(θ²) = 2.9 W there.
        let drive = f64::midpoint(2.0_f64.tanh(), 1.0);
        for config in [
            Config::Exact(Exact::new(1e-3)),
            Config::Euler(Euler::new(1e-3)),
        ] {
            let mut state = State::default();
            for _ in 0..20_000 {
                config.step(&mut state, 2.9, drive, drive);
            }
            assert!((state.theta - 1.015).abs() < 5e-4, "{}", state.theta);
            assert!((state.theta * (state.theta * state.theta).exp() - 2.9 * drive).abs() < 1e-6);
        }
    }

    #[test]
    fn newton_weights_integrate_a_cubic_exactly() {
        // With A → 0 (slow whisker) the double integral of s(s+1)(s+2)/6 over a tick is
        // ∫₀¹ (1 − s) s(s+1)(s+2)/6 ds = 19/180, the single one 3/8.
        let cycles = 1e-4;
        let exact = Exact::<f64>::new(cycles);
        let [spring, _] = super::rates(cycles);
        assert!((exact.correct[0] / spring - 19.0 / 180.0).abs() < 1e-4);
        assert!((exact.correct[1] / spring - 3.0 / 8.0).abs() < 1e-3);
        assert!((exact.predict[1][1] / spring - 0.5).abs() < 1e-2);
    }
}
