//! Every term of the oscillators (BIOTACT eqs. 3 to 5) against closed forms,
//! far from the circle and near it, with one side and with two.

use crate::settings::plain;
use core::f64::consts::TAU;
use whisking::oscillator::{self, Psi};
use whisking::{Fix, Integrator, Real, Settings};

const TICK_HZ: f64 = 2000.0;
const HZ: f64 = 8.0;
const CYCLES: f64 = HZ / TICK_HZ;

struct Running<R: Real, const S: usize> {
    config: oscillator::Config<R>,
    state: oscillator::State<R>,
}

impl<R: Real, const S: usize> Running<R, S> {
    fn new(integrator: Integrator, coupling: bool, psi: [Psi<f64>; S]) -> Self {
        let settings = Settings {
            coupling,
            ..plain(integrator, TICK_HZ, HZ)
        };
        let start = settings.start::<R>(&psi, &[&[1.0][..]; S]).unwrap();
        let kept = start.sides.iter().map(|side| side.oscillator);
        Self {
            config: settings.build().unwrap().oscillators,
            state: oscillator::State::new(kept.collect()),
        }
    }

    fn tick(&mut self, noise: [Psi<f64>; S]) -> [Psi<f64>; S] {
        let noise = noise.map(|n| n.map(R::from_f64));
        self.config.step(&mut self.state, Some(&noise));
        self.psi()
    }

    fn psi(&self) -> [Psi<f64>; S] {
        let psi = self.config.psi(&self.state).into_array().unwrap();
        psi.map(|p: Psi<R>| p.map(R::to_f64))
    }

    fn drives(&self) -> [f64; S] {
        let drives = self.config.drives(&self.state);
        core::array::from_fn(|side| drives[side].to_f64())
    }
}

fn turned([a, b]: Psi<f64>, angle: f64) -> Psi<f64> {
    let (s, c) = angle.sin_cos();
    [c * a - s * b, s * a + c * b]
}

/// Alone a side turns evenly and its radius relaxes with two whisk periods.
fn alone(start: Psi<f64>, ticks: usize) -> Psi<f64> {
    let whisks = ticks as f64 * CYCLES;
    let r = start[0].hypot(start[1]);
    let grown = (1.0 + (r - 1.0) * (-whisks / 2.0).exp()) / r;
    turned(start.map(|x| x * grown), TAU * whisks)
}

fn follows_the_closed_form<R: Real, const S: usize>(start: [Psi<f64>; S], within: f64) {
    let mut running = Running::<R, S>::new(Integrator::Exact, false, start);
    for n in 1..=1000 {
        let psi = running.tick([[0.0; 2]; S]);
        let drives = running.drives();
        for side in 0..S {
            let truth = alone(start[side], n);
            for k in 0..2 {
                let error = (psi[side][k] - truth[k]).abs();
                assert!(error < within, "{start:?}, {n}: {error:e}");
            }
            let error = (drives[side] - truth[0]).abs();
            assert!(error < within, "drive, {start:?}, {n}: {error:e}");
        }
    }
}

#[test]
fn sides_that_do_not_pull_each_other_follow_the_closed_form() {
    for start in [
        // Near the circle, then far from it: both radii, the sum, the difference.
        [[1.02, 0.0], [0.5, -0.84]],
        [[0.0, 0.99], [-1.01, 0.0]],
        [[1.4, 0.0], [1.4, 0.0]],
        [[1.3, 0.0], [0.6, 0.0]],
        [[0.2, 0.1], [0.0, 1.2]],
    ] {
        follows_the_closed_form::<f64, 2>(start, 1e-11);
        follows_the_closed_form::<f32, 2>(start, 5e-6);
        follows_the_closed_form::<Fix, 2>(start, 5e-6);
    }
}

#[test]
fn a_lone_side_follows_the_closed_form() {
    for start in [[1.02, 0.0], [0.0, -0.98], [1.4, 0.0], [0.3, 0.0]] {
        follows_the_closed_form::<f64, 1>([start], 1e-11);
        follows_the_closed_form::<f32, 1>([start], 5e-6);
        follows_the_closed_form::<Fix, 1>([start], 5e-6);
    }
}

/// Eqs. 3 and 4 times T, written out.
#[test]
fn euler_takes_the_right_hand_sides_as_they_stand() {
    let start = [[0.9, -0.4], [0.3, 0.8]];
    let noise = [[1e-3, -2e-3], [3e-3, 5e-3]];
    let found = Running::<f64, 2>::new(Integrator::Euler, true, start).tick(noise);
    for side in 0..2 {
        let [a, b] = start[side];
        let other = start[1 - side][0];
        let r = f64::hypot(a, b);
        let radial = CYCLES / 2.0 * (1.0 - r) / r;
        let turn = TAU * CYCLES;
        let da = radial * a - turn * b + CYCLES / 2.0 * (other - a) + noise[side][0];
        let db = radial * b + turn * a + noise[side][1];
        assert!((found[side][0] - a - da).abs() < 1e-15);
        assert!((found[side][1] - b - db).abs() < 1e-15);
    }
}

/// Noise comes in the middle of the exact step, half a tick before ψ is read;
/// after the radial part, so that it adds what it is.
#[test]
fn noise_reaches_the_side_it_is_for() {
    let start = [[0.9, -0.4], [0.3, 0.8]];
    let noise = [[1e-2, -2e-2], [3e-2, 5e-2]];
    let quiet = Running::<f64, 2>::new(Integrator::Exact, false, start).tick([[0.0; 2]; 2]);
    let noisy = Running::<f64, 2>::new(Integrator::Exact, false, start).tick(noise);
    for side in 0..2 {
        let added = turned(noise[side], TAU * CYCLES / 2.0);
        for k in 0..2 {
            let found = noisy[side][k] - quiet[side][k];
            assert!((found - added[k]).abs() < 1e-15, "{side} {k}: {found}");
        }
    }
}

#[test]
fn no_noise_leads_beyond_the_limits() {
    fn check<R: Real>() {
        for integrator in [Integrator::Euler, Integrator::Exact] {
            let mut running = Running::<R, 2>::new(integrator, true, [[1.0, 0.0]; 2]);
            for n in 0..400_u32 {
                let x = if n / 50 % 2 == 0 { 0.6 } else { -0.6 };
                for psi in running.tick([[x, 0.9 * x], [-x, x]]) {
                    assert!(psi[0].abs() <= 1.5 && psi[1].abs() <= 1.5, "{psi:?}");
                }
            }
            // What came of the limits is what the next tick starts from.
            for psi in running.tick([[0.0; 2]; 2]) {
                assert!((1.3..2.2).contains(&psi[0].hypot(psi[1])), "{psi:?}");
            }
        }
    }
    check::<f64>();
    check::<f32>();
    check::<Fix>();
}

/// A state at its limit is at its limit, not half a tick from it.
#[test]
fn a_limited_state_is_read_as_its_limit() {
    for integrator in [Integrator::Euler, Integrator::Exact] {
        let mut running = Running::<f64, 2>::new(integrator, false, [[1.2, 0.3]; 2]);
        for psi in running.tick([[0.8, 0.0]; 2]) {
            assert!((psi[0] - 1.5).abs() < 1e-12, "{psi:?}");
            assert!((psi[1] - 0.32).abs() < 0.02, "{psi:?}");
        }
    }
}
