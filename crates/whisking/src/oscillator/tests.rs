//! What the oscillators must do, whoever steps them; every term of BIOTACT's eqs. 3 to 5 against
//! closed forms, far from the circle and near it, with one side and with two.

use core::f64::consts::TAU;

use super::{Config, Euler, Exact, PSI_LIMIT, Psi, State, keep, psi_limit};
use crate::list::listed;
use crate::{Fix, Integrator, Real};

/// Whisks a tick where a test is not about them: 8 Hz at 2 kHz.
const CYCLES: f64 = 8.0 / 2000.0;

struct Running<R: Real, const S: usize>(Config<R>, State<R>);

impl<R: Real, const S: usize> Running<R, S> {
    fn new(integrator: Integrator, coupling: bool, cycles: f64, psi: [Psi<f64>; S]) -> Self {
        let exact = Config::Exact(Exact::new(cycles, coupling));
        let (config, kept) = match integrator {
            Integrator::Exact => (exact, keep(&psi, cycles, coupling)),
            Integrator::Euler => (Config::Euler(Euler::new(cycles, coupling)), psi),
        };
        Self(config, State::new(listed(kept.map(|p| p.map(R::from_f64)))))
    }

    fn exact(cycles: f64, psi: [Psi<f64>; S]) -> Self {
        Self::new(Integrator::Exact, true, cycles, psi)
    }

    fn euler(cycles: f64, psi: [Psi<f64>; S]) -> Self {
        Self::new(Integrator::Euler, true, cycles, psi)
    }

    fn psi(&self) -> [Psi<f64>; S] {
        let psi = self.0.psi(&self.1).into_array().unwrap();
        psi.map(|p: Psi<R>| p.map(R::to_f64))
    }

    fn run(&mut self, ticks: usize) -> [Psi<f64>; S] {
        for _ in 0..ticks {
            self.0.step(&mut self.1, None);
        }
        self.psi()
    }

    fn tick(&mut self, noise: [Psi<f64>; S]) -> [Psi<f64>; S] {
        let noise = noise.map(|n| n.map(R::from_f64));
        self.0.step(&mut self.1, Some(&noise));
        self.psi()
    }
}

#[test]
fn every_format_has_the_same_limit() {
    assert_eq!(psi_limit::<f64>(), PSI_LIMIT);
    assert_eq!(f64::from(psi_limit::<f32>()), PSI_LIMIT);
    assert_eq!(psi_limit::<Fix>().to_f64(), PSI_LIMIT);
}

fn radius([a, b]: Psi<f64>) -> f64 {
    a.hypot(b)
}

#[test]
fn the_limit_cycle_is_the_unit_circle_at_any_step_and_in_any_format() {
    fn check<R: Real>(rounding: f64) {
        for cycles in [1e-4, 1e-3, 1.25e-2, 0.1] {
            let mut running = Running::<R, 2>::exact(cycles, [[1.0, 0.0]; 2]);
            let whisk = (1.0 / cycles) as usize;
            for _ in 0..8 {
                for radius in running.run(whisk / 8 + 1).map(radius) {
                    assert!((radius - 1.0).abs() < rounding, "{cycles}: {radius}");
                }
            }
        }
    }
    check::<f64>(1e-12);
    check::<f32>(3e-7);
    check::<Fix>(2e-6);
}

/// Of one side and of two, half a tick of `cycles` behind where the integrator keeps that.
#[test]
fn the_phase_runs_with_the_angle_in_every_format() {
    fn check<R: Real, const S: usize>(mut running: Running<R, S>, cycles: f64) {
        for _ in 0..(1.2 / cycles) as usize {
            let psi = running.run(1);
            for (side, [a, b]) in psi.into_iter().enumerate() {
                let turns = f64::from(running.0.phase(&running.1, side)) / 65_536.0;
                let behind = b.atan2(a) / TAU - turns;
                let behind = behind - behind.round();
                // 4.07 degrees, and a tick.
                assert!(behind.abs() < 0.0114 + cycles, "{side}: {behind}");
            }
        }
    }
    let starts = [[1.0, 0.0], [-0.6, 0.8]];
    check(Running::<f32, 2>::exact(1e-3, starts), 1e-3);
    check(Running::<Fix, 2>::exact(1e-3, starts), 1e-3);
    check(Running::<Fix, 1>::exact(4e-3, [[0.0, 1.0]]), 4e-3);
    check(Running::<f64, 2>::euler(1e-3, starts), 1e-3);
}

/// The text's "time constant of one whisking period" is 2.0 T_W of the phase
/// difference: 2.0042 over these two whisks by a fine Runge-Kutta solution.
#[test]
fn phase_difference_decays_with_two_whisk_periods() {
    let offset = 0.2_f64;
    let start = [[1.0, 0.0], [offset.cos(), offset.sin()]];
    let [l, r] = Running::<f64, 2>::exact(1e-3, start)
        .run(2_000)
        .map(|p| p[1].atan2(p[0]));
    let tau = -2.0 / ((r - l).abs() / offset).ln();
    assert!((tau - 2.0042).abs() < 1e-4, "{tau} whisk periods");
}

#[test]
fn the_origin_is_left_along_protraction_in_every_format() {
    fn check<R: Real>() {
        for mut running in [
            Running::<R, 2>::exact(1e-3, [[0.0; 2]; 2]),
            Running::<R, 2>::euler(1e-3, [[0.0; 2]; 2]),
        ] {
            let [[a, b], _] = running.run(1);
            assert!(a > 1e-4 && b.abs() < 1e-5, "{a} {b}");
            for psi in running.run(20_000) {
                assert!((radius(psi) - 1.0).abs() < 0.05, "{psi:?}");
            }
        }
    }
    check::<f64>();
    check::<f32>();
    check::<Fix>();
}

/// ψ of one side is what it was and the difference, that of the other what it was, however the
/// integrator keeps them; and what becomes of the difference is what two runs show that began so
/// far from one another.
#[test]
fn a_side_is_shifted_by_a_difference_which_turns_with_it() {
    let cycles = CYCLES;
    let start = [[1.0, 0.0], [0.6, 0.5]];
    let difference = [3e-4, -2e-4];
    for new in [Running::<f64, 2>::exact, Running::<f64, 2>::euler] {
        for side in 0..2 {
            let mut plain = new(cycles, start);
            let mut shifted = new(cycles, start);
            let before = plain.run(40);
            let _ = shifted.run(40);
            shifted.0.shift(&mut shifted.1, side, difference);
            let after = shifted.run(0);
            for (n, (a, b)) in after.iter().zip(before).enumerate() {
                let expected = if n == side { difference } else { [0.0; 2] };
                for k in 0..2 {
                    assert!((a[k] - b[k] - expected[k]).abs() < 1e-15, "{n} {k}");
                }
            }
            let (plain, aged) = (plain.run(8), shifted.0.aged(difference, 8));
            let shifted = shifted.run(8);
            for k in 0..2 {
                let found = shifted[side][k] - plain[side][k];
                assert!((found - aged[k]).abs() < 8.0 * cycles * radius(difference));
                assert!((aged[k] - difference[k]).abs() > 1e-5, "it has turned");
            }
        }
    }
}

fn turned([a, b]: Psi<f64>, angle: f64) -> Psi<f64> {
    let (s, c) = angle.sin_cos();
    [c * a - s * b, s * a + c * b]
}

/// Alone a side turns evenly and its radius relaxes with two whisk periods.
fn alone(start: Psi<f64>, ticks: usize) -> Psi<f64> {
    let whisks = ticks as f64 * CYCLES;
    let r = radius(start);
    let grown = (1.0 + (r - 1.0) * (-whisks / 2.0).exp()) / r;
    turned(start.map(|x| x * grown), TAU * whisks)
}

fn follows_the_closed_form<R: Real, const S: usize>(start: [Psi<f64>; S], within: f64) {
    let mut running = Running::<R, S>::new(Integrator::Exact, false, CYCLES, start);
    for n in 1..=1000 {
        let psi = running.tick([[0.0; 2]; S]);
        let drives = running.0.drives(&running.1);
        for side in 0..S {
            let truth = alone(start[side], n);
            for k in 0..2 {
                let error = (psi[side][k] - truth[k]).abs();
                assert!(error < within, "{start:?}, {n}: {error:e}");
            }
            let error = (drives[side].to_f64() - truth[0]).abs();
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
    let found = Running::<f64, 2>::euler(CYCLES, start).tick(noise);
    for side in 0..2 {
        let [a, b] = start[side];
        let other = start[1 - side][0];
        let r = radius(start[side]);
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
    let [quiet, noisy] = [[[0.0; 2]; 2], noise]
        .map(|noise| Running::<f64, 2>::new(Integrator::Exact, false, CYCLES, start).tick(noise));
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
            let mut running = Running::<R, 2>::new(integrator, true, CYCLES, [[1.0, 0.0]; 2]);
            for n in 0..400_u32 {
                let x = if n / 50 % 2 == 0 { 0.6 } else { -0.6 };
                for psi in running.tick([[x, 0.9 * x], [-x, x]]) {
                    assert!(psi[0].abs() <= 1.5 && psi[1].abs() <= 1.5, "{psi:?}");
                }
            }
            // What came of the limits is what the next tick starts from.
            for psi in running.tick([[0.0; 2]; 2]) {
                assert!((1.3..2.2).contains(&radius(psi)), "{psi:?}");
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
        let mut running = Running::<f64, 2>::new(integrator, false, CYCLES, [[1.2, 0.3]; 2]);
        for psi in running.tick([[0.8, 0.0]; 2]) {
            assert!((psi[0] - 1.5).abs() < 1e-12, "{psi:?}");
            assert!((psi[1] - 0.32).abs() < 0.02, "{psi:?}");
        }
    }
}
