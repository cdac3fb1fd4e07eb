//! What the muscles must do, whoever steps them.

use super::exact::Lag;
use super::{Config, Euler, Exact, History, State, drive, pace};
use crate::{Fix, Real};

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
    let [exact, euler] = [
        Config::Exact(Exact::new(1e-3)),
        Config::Euler(Euler::new(1e-3)),
    ];
    for config in [exact, euler] {
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
    // A lag that hardly decays is its rate times the integral of each basis
    // polynomial over a tick: Adams and Bashforth's numbers.
    let lag = Lag::<f64>::new(1e-6);
    let [first, second, third] = lag.predict.0;
    for (found, expected) in [
        (lag.decay, 1.0),
        (first, 1.0 / 2.0),
        (second, 5.0 / 12.0),
        (third, 3.0 / 8.0),
        (lag.correct, 251.0 / 720.0),
    ] {
        assert!((found / 1e-6 - expected).abs() < 2e-6, "{expected}");
    }
}

/// The force follows a polynomial of fourth degree without error, however fast
/// the lag: ∫ λ e^{−λ(1 − s)} s^4 ds over one tick.
#[test]
fn a_fast_lag_answers_a_quartic_as_the_closed_form_says() {
    let rate = 0.8_f64;
    let lag = Lag::<f64>::new(rate);
    let at = |s: f64| s.powi(4);
    let past = [0.0, -1.0, -2.0, -3.0].map(at);
    let d1 = past[0] - past[1];
    let d2 = past[0] - 2.0 * past[1] + past[2];
    let d3 = past[0] - 3.0 * past[1] + 3.0 * past[2] - past[3];
    let d4 = at(1.0) - 4.0 * past[0] + 6.0 * past[1] - 4.0 * past[2] + past[3];
    let [w1, w2, w3] = lag.predict.0;
    let found = past[0] * lag.decay + d1 * w1 + d2 * w2 + d3 * w3 + d4 * lag.correct;
    // By parts: I_n = 1 − (n/λ) I_{n−1}, I_0 = 1 − e^{−λ}.
    let expected = (1..=4).fold(1.0 - (-rate).exp(), |before, n| {
        1.0 - f64::from(n) / rate * before
    });
    assert!((found - expected).abs() < 1e-13, "{found} {expected}");
}

/// At few ticks a whisk a gain that jumps turns the force on and off from tick
/// to tick, and its fourth difference would leave fixed point.
#[test]
fn no_rhythm_of_the_gain_leads_beyond_the_bounds() {
    fn run<R: Real>(cycles: f64, period: usize) {
        let config = Config::Exact(Exact::<R>::new(cycles));
        let first = drive(R::from_f64(1.5));
        let mut state = State::new(History {
            force: [first, R::ZERO, R::ZERO, R::ZERO],
        });
        for n in 0..400 {
            let phase = core::f64::consts::TAU * cycles * n as f64;
            let drive = drive(R::from_f64(1.5 * phase.cos()));
            let open = (n / period).is_multiple_of(2);
            let gain = R::from_f64(if open { 2.9 } else { 0.0 });
            config.step(&mut state, gain, drive, drive);
            let [theta, slow, fast] = [state.theta, state.kept[0], state.kept[1]].map(Real::to_f64);
            let is_within = theta.abs() < 2.5 && slow.abs() < 5.0 && fast.abs() < 5.0;
            assert!(is_within, "{cycles} {period} {n}: {theta} {slow} {fast}");
        }
    }
    for cycles in [1e-3, 1.25e-2, 0.05, 0.125, 0.25] {
        for period in 1..8 {
            run::<Fix>(cycles, period);
            run::<f32>(cycles, period);
        }
    }
}
