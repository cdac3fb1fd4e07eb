//! Every term of the muscles and of the gain (BIOTACT eqs. 7 and 8) against the same written out
//! in f64.

use crate::settings::plain;
use whisking::muscle::{self, PEAK_GAIN};
use whisking::{Fix, GateSettings, Integrator, Real, Settings, State};

fn settings(integrator: Integrator) -> Settings {
    let gate = |gain, tau_s| Some(GateSettings { gain, tau_s });
    Settings {
        coupling: true,
        rcp: gate(0.7, 0.02),
        cia: gate(0.5, 0.03),
        ..plain(integrator, 200.0, 2.0)
    }
}

/// Forward Euler as the papers write it, within its limits of ±2; at 25 Hz and
/// 200 Hz it is unstable and meets them.
#[test]
fn euler_takes_the_muscle_as_it_stands() {
    for (frequency_hz, within) in [(2.0, 1e-13), (25.0, 1e-11)] {
        let settings = Settings {
            frequency_hz,
            ..settings(Integrator::Euler)
        };
        let config = settings.build::<f64>().unwrap().muscle;
        let h = 10.0 * frequency_hz / 200.0;
        let mut state = muscle::State::default();
        let (mut theta, mut v) = (0.0_f64, 0.0_f64);
        for n in 0..40 {
            let (gain, drive) = (2.9 - 0.05 * f64::from(n), 0.9 - 0.01 * f64::from(n));
            config.step(&mut state, gain, drive, 0.123);
            // Beyond ±1.5 the loss of force is what it is there.
            let loss = (-theta.abs().min(1.5).powi(2)).exp();
            let pull = h * (gain * drive * loss - theta);
            let next = (v + pull).clamp(-2.0, 2.0) - 4.0 * h * v;
            theta = (theta + h * v).clamp(-2.0, 2.0);
            v = next.clamp(-2.0, 2.0);
            assert!((state.theta - theta).abs() < within, "{n}: {}", state.theta);
            assert!((state.kept()[0] - v).abs() < within, "{n}");
        }
    }
}

/// The gain of every whisker is 1.45 (1 − z) g, both as their means over the
/// tick; the drive of the papers' integrator is that before the tick.
#[test]
fn gates_and_drives_reach_the_muscles() {
    for integrator in [Integrator::Euler, Integrator::Exact] {
        let settings = settings(integrator);
        let config = settings.build::<f64>().unwrap();
        let start = settings
            .start::<f64>(&[[1.0, 0.0], [0.6, 0.5]], &[&[1.0, 0.4], &[0.7, 1.2]])
            .unwrap();
        let mut state = State::new(&start, 1);
        let mut truth = state.clone();
        let mut drives = [1.0_f64, 0.6].map(|x| f64::midpoint((2.0 * x).tanh(), 1.0));
        for n in 0..60 {
            let contact = if n % 15 == 3 { [0.8, 0.1] } else { [0.0; 2] };
            config.step(&mut state, &contact);

            config.oscillators.step(&mut truth.oscillators, None);
            let psi = config.oscillators.psi(&truth.oscillators);
            for side in 0..2 {
                let after = f64::midpoint((2.0 * psi[side][0]).tanh(), 1.0);
                let z = &mut truth.sides[side].z;
                config.rcp.unwrap().step(z, contact[side]);
                let whiskers = truth.whiskers.iter_mut();
                for whisker in whiskers.filter(|whisker| usize::from(whisker.side) == side) {
                    let cia = config.cia.unwrap();
                    let nominal = whisker.nominal();
                    cia.step(&mut whisker.lift, nominal, contact[0]);
                    let g = nominal + whisker.lift.mean;
                    let gain = PEAK_GAIN * (1.0 - z.mean) * g;
                    let muscle = &mut whisker.muscle;
                    config.muscle.step(muscle, gain, drives[side], after);
                }
                drives[side] = after;
            }
            for (found, truth) in state.theta().zip(truth.theta()) {
                assert!((found - truth).abs() < 1e-12, "{integrator:?}, {n}");
            }
        }
    }
}

/// Products lean neither up nor down: their mean error is a small part of a step.
#[test]
fn products_in_fixed_point_do_not_lean() {
    const STEP: f64 = 1.0 / 268_435_456.0;
    let numbers = || (0..20_000_i32).map(|n| Fix(n.wrapping_mul(100_003) - 1_000_000_007));
    let mean = |errors: &mut dyn Iterator<Item = f64>| errors.sum::<f64>() / 20_000.0 / STEP;

    let factor = Fix::coefficient(0.011);
    let exact = f64::from(factor.mantissa) / f64::from(16 + factor.shift).exp2();
    let lean = mean(&mut numbers().map(|x| x.times(factor).to_f64() - x.to_f64() * exact));
    assert!(lean.abs() < 0.1, "constants: {lean}");

    for share in [0.011, 0.83] {
        let fine = Fix::fine(share);
        let exact = f64::from(fine.mantissa) / f64::from(32 + fine.shift).exp2();
        assert!((exact / share - 1.0).abs() < 5e-10);
        let lean = mean(&mut numbers().map(|x| x.times_fine(fine).to_f64() - x.to_f64() * exact));
        assert!(lean.abs() < 0.1, "fine constants: {lean}");
    }

    let other = Fix(187_654_321);
    let lean = mean(&mut numbers().map(|x| (x * other).to_f64() - x.to_f64() * other.to_f64()));
    assert!(lean.abs() < 1.0, "numbers: {lean}");
}

#[test]
fn readings_and_constants_in_fixed_point_are_the_nearest() {
    for code in -8191..=8191_i16 {
        let error = Fix::from_code(code).to_f64() - f64::from(code) / 8191.0;
        assert!(error.abs() < 2e-8, "{code}: {error:e}");
    }
    let nearest = |mantissa: f64, value: f64, shift: i32| {
        let scaled = value * f64::from(shift).exp2();
        assert!((mantissa - scaled).abs() <= 0.5, "{value}");
    };
    for n in 1..2000 {
        let value = f64::from(n) * 4.7e-4;
        let fine = Fix::fine(value);
        assert!(fine.mantissa >= 0, "{value}");
        nearest(f64::from(fine.mantissa), value, 32 + fine.shift);
        let factor = Fix::coefficient(value);
        nearest(f64::from(factor.mantissa), value, 16 + factor.shift);
        let row = Fix::row([value, value / 3.0]);
        nearest(f64::from(row.mantissas[1]), value / 3.0, 16 + row.shift);
    }
}
