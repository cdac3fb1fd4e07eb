//! The muscle and mass of one whisker (BIOTACT eqs. 6 to 8).
//!
//! m d²θ/dt² = q W − k θ − ν dθ/dt with q = 1.45 (1 − z) g exp(−θ²), k = 1,
//! m = T_W²/100 and ν = 4 √(k m): natural frequency ω_n = 10 f_W rad/s, damping
//! ratio 2. With f = W exp(−θ²), the force per gain a = 1.45 (1 − z) g, and
//! v = (dθ/dt)/ω_n, the equation is θ' = h v, v' = h (a f − θ − 4 v) a tick,
//! h = ω_n T: linear in (θ, v) with input a f, and every state near one.
//!
//! [`Exact`] propagates the linear part exactly and takes f as the quartic
//! through its last values: an exponential Adams method of fifth order,
//! predicted and corrected once, so one exponential and one drive a tick.
//! The gain multiplies after the differences are taken, so that a jump of z or
//! g does not enter the history. The linear part acts on θ − a f, so that the
//! equilibrium is exact however the coefficients are rounded.

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
pub enum Config<R: Real> {
    /// Forward Euler.
    Euler(Euler<R>),
    /// Exact linear part, fifth-order exponential multistep.
    Exact(Exact<R>),
}

/// Forward Euler: θ, v and the force at the state before the step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Euler<R: Real> {
    /// h = ω_n T.
    pub spring: R::Coefficient,
    /// 4 h.
    pub damping: R::Coefficient,
}

/// Exact linear propagator and multistep weights; row 0 gives the increment of
/// θ, row 1 that of v.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exact<R: Real> {
    /// exp(A) − 1 on (θ − a f, v).
    pub linear: [[R::Coefficient; 2]; 2],
    /// Weights of ∇f, ∇²f and ∇³f (predictor).
    pub predict: [[R::Coefficient; 3]; 2],
    /// Weight of ∇⁴f at the new end (corrector).
    pub correct: [R::Coefficient; 2],
}

/// f at the last tick and its backward differences; unused by Euler.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct History<R> {
    /// f, ∇f, ∇²f, ∇³f.
    pub force: [R; 4],
}

/// (θ, v) of one whisker and what its integrator remembers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct State<R: Real> {
    /// Protraction θ; θ' = 100 θ + 50 degrees.
    pub theta: R,
    /// v = (dθ/dt)/ω_n.
    pub velocity: R,
    carry: R::Carry,
    history: History<R>,
}

/// h = ω_n T for `cycles` = f_W T.
pub(crate) fn pace(cycles: f64) -> f64 {
    STIFFNESS * cycles
}

/// dv/dt in ticks at `theta` and `velocity` under the force `push` = a f.
pub(crate) fn acceleration(cycles: f64, [theta, velocity]: [f64; 2], push: f64) -> f64 {
    pace(cycles) * (push - theta - DAMPING * velocity)
}

impl<R: Real> State<R> {
    /// At rest with these forces behind it.
    pub fn new(history: History<R>) -> Self {
        Self {
            history,
            ..Self::default()
        }
    }
}

impl<R: Real> Euler<R> {
    pub(crate) fn new(cycles: f64) -> Self {
        Self {
            spring: R::coefficient(pace(cycles)),
            damping: R::coefficient(DAMPING * pace(cycles)),
        }
    }

    #[inline]
    fn step(&self, state: &mut State<R>, gain: R, drive: R) {
        let push = gain * (drive * state.theta.exp_neg_square());
        let velocity = state.velocity;
        let pull = (push - state.theta).times(self.spring);
        state.velocity = velocity + pull - velocity.times(self.damping);
        state
            .theta
            .accumulate(&mut state.carry, velocity.times(self.spring));
    }
}

impl<R: Real> Exact<R> {
    pub(crate) fn new(cycles: f64) -> Self {
        let h = pace(cycles);
        // (θ, v) driven by a chain of integrators: the exponential holds the
        // propagator and, beside it, the response to each power s^k/k! of time.
        let mut a: Matrix<7> = [[0.0; 7]; 7];
        a[0][1] = h;
        a[1][..3].copy_from_slice(&[-h, -DAMPING * h, h]);
        for k in 2..6 {
            a[k][k + 1] = 1.0;
        }
        let e = exponential(&a);
        // The response to 1 is what the linear part does not do: on θ − a f.
        let row = |i: usize| {
            let [power1, power2, power3, power4] = [e[i][3], e[i][4], e[i][5], e[i][6]];
            // Newton's basis s, s(s+1)/2, s(s+1)(s+2)/6, s(s+1)(s+2)(s+3)/24 in
            // powers s^k/k!.
            [
                power1,
                power2 + power1 / 2.0,
                power3 + power2 + power1 / 3.0,
                power4 + 1.5 * power3 + 11.0 / 12.0 * power2 + power1 / 4.0,
            ]
        };
        let weights = [row(0), row(1)];
        Self {
            linear: [[e[0][0] - 1.0, e[0][1]], [e[1][0], e[1][1] - 1.0]]
                .map(|row| row.map(R::coefficient)),
            predict: weights.map(|w| [w[0], w[1], w[2]].map(R::coefficient)),
            correct: weights.map(|w| R::coefficient(w[3])),
        }
    }

    #[inline]
    fn step(&self, state: &mut State<R>, gain: R, drive: R) {
        let [f, d1, d2, d3] = state.history.force;
        let (off, velocity) = (state.theta - gain * f, state.velocity);
        let predict = |i: usize| {
            let [w1, w2, w3] = self.predict[i];
            off.times(self.linear[i][0])
                + velocity.times(self.linear[i][1])
                + gain * (d1.times(w1) + d2.times(w2) + d3.times(w3))
        };
        let change = [predict(0), predict(1)];
        let force = drive * (state.theta + change[0]).exp_neg_square();
        let n1 = force - f;
        let n2 = n1 - d1;
        let n3 = n2 - d2;
        let correction = gain * (n3 - d3);
        let [theta, v] = self.correct.map(|weight| correction.times(weight));
        state.theta.accumulate(&mut state.carry, change[0] + theta);
        state.velocity = velocity + (change[1] + v);
        state.history.force = [force, n1, n2, n3];
    }
}

impl<R: Real> Config<R> {
    /// One tick of one whisker: `gain` is 1.45 (1 − z) g, `before` and `after`
    /// the drive W at the two ends of the tick.
    ///
    /// θ and v are held within ±2, which no sane input reaches (the static
    /// solution at full drive is 1.015), so that no input can make them grow.
    #[inline]
    pub fn step(&self, state: &mut State<R>, gain: R, before: R, after: R) {
        match self {
            Self::Euler(euler) => euler.step(state, gain, before),
            Self::Exact(exact) => exact.step(state, gain, after),
        }
        state.theta = state.theta.clamp(-R::TWO, R::TWO);
        state.velocity = state.velocity.clamp(-R::TWO, R::TWO);
    }
}

#[cfg(test)]
mod tests {
    use super::{Config, Euler, Exact, History, State, pace};

    #[test]
    fn a_constant_force_is_answered_as_the_closed_form_says() {
        // Without the loss of force (tiny gain) the answer to a step is
        // 1 + (p2 e^{p1 t} − p1 e^{p2 t})/(p1 − p2), p = −ω(2 ∓ √3).
        let cycles = 1.25e-2;
        let config = Config::Exact(Exact::new(cycles));
        let mut state = State::new(History {
            force: [1.0, 0.0, 0.0, 0.0],
        });
        let gain = 1e-6;
        for n in 1..=80 {
            config.step(&mut state, gain, 1.0, 1.0);
            let t = pace(cycles) * f64::from(n);
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
            let balance = state.theta * (state.theta * state.theta).exp();
            assert!((balance - 2.9 * drive).abs() < 1e-6);
        }
    }

    #[test]
    fn newton_weights_integrate_polynomials_exactly() {
        // With a slow whisker v is h times the integral of each basis polynomial
        // over a tick (Adams and Bashforth's numbers), θ h² times its double
        // integral ∫ (1 − s) p(s) ds.
        let cycles = 1e-4;
        let (exact, h) = (Exact::<f64>::new(cycles), pace(cycles));
        for (found, expected) in exact.predict[1]
            .iter()
            .zip([1.0 / 2.0, 5.0 / 12.0, 3.0 / 8.0])
        {
            assert!((found / h - expected).abs() < 2e-3, "{expected}");
        }
        assert!((exact.correct[1] / h - 251.0 / 720.0).abs() < 2e-3);
        for (found, expected) in exact.predict[0]
            .iter()
            .zip([1.0 / 6.0, 1.0 / 8.0, 19.0 / 180.0])
        {
            assert!((found / (h * h) - expected).abs() < 1e-3, "{expected}");
        }
        assert!((exact.correct[0] / (h * h) - 3.0 / 32.0).abs() < 1e-3);
    }
}
