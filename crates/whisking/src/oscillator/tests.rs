//! What the oscillators must do, whoever steps them.

use super::{Config, Euler, Exact, PSI_LIMIT, Psi, State, keep, psi_limit};
use crate::list::listed;
use crate::{Fix, Real};

struct Running<R: Real, const S: usize>(Config<R>, State<R>);

impl<R: Real, const S: usize> Running<R, S> {
    fn exact(cycles: f64, psi: [Psi<f64>; S]) -> Self {
        let config = Config::Exact(Exact::new(cycles, true));
        Self::new(config, keep(&psi, cycles, true))
    }

    fn euler(cycles: f64, psi: [Psi<f64>; S]) -> Self {
        Self::new(Config::Euler(Euler::new(cycles, true)), psi)
    }

    fn new(config: Config<R>, kept: [Psi<f64>; S]) -> Self {
        Self(config, State::new(listed(kept.map(|p| p.map(R::from_f64)))))
    }

    fn run(&mut self, ticks: usize) -> [Psi<f64>; S] {
        for _ in 0..ticks {
            self.0.step(&mut self.1, None);
        }
        let psi = self.0.psi(&self.1).into_array().unwrap();
        psi.map(|p: Psi<R>| p.map(R::to_f64))
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
                let behind = b.atan2(a) / core::f64::consts::TAU - turns;
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
    let cycles = 8.0 / 2000.0;
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
