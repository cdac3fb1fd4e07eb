//! Motors that are known are found again.

use proptest::prelude::*;
use wire::Flags;

use super::{Motor, identify, suggest};
use crate::sample::Sample;

const TICK_S: f64 = 0.0005;
/// An encoder's count, and the step of an angle in a record, degrees.
const COUNT_DEG: f64 = 0.064;
const RECORD_DEG: f64 = 100.0 / 8192.0;
const STEPS: usize = 50;

fn followed(motor: Motor, kp: f64, kd: f64) -> Vec<Sample> {
    let rounded = |value: f64, step: f64| (value / step).floor() * step;
    let acceleration = motor.speed_deg_s / motor.tau_s;
    let (mut angle, mut speed) = (50.0_f64, 0.0_f64);
    let mut before = angle;
    let mut samples = Vec::new();
    for n in 0..4_000 {
        let setpoint = 50.0 + [30.0, 0.0, 20.0, 5.0, 40.0][n / 800];
        let measured = rounded(angle, COUNT_DEG);
        let velocity = (measured - before) / TICK_S;
        let duty = (kp * (setpoint - measured) - kd * velocity).clamp(-1.0, 1.0);
        before = measured;
        for _ in 0..STEPS {
            let dt = TICK_S / STEPS as f64;
            let push = acceleration * duty - speed / motor.tau_s;
            let friction = acceleration * motor.friction;
            let still = speed.abs() < friction * dt;
            if still && push.abs() < friction {
                speed = 0.0;
            } else {
                let against = if still { push } else { speed };
                speed += (push - friction.copysign(against)) * dt;
            }
            angle += speed * dt;
        }
        samples.push(Sample {
            t_s: n as f64 * TICK_S,
            words: [0x8000; 2],
            codes: [8192; 2],
            setpoint_deg: setpoint,
            measured_deg: rounded(measured, RECORD_DEG),
            duty,
            z: 0.0,
            contact: 0.0,
            flags: Flags::VALID,
        });
    }
    samples
}

fn near(found: f64, expected: f64, tolerance: f64) -> Result<(), TestCaseError> {
    prop_assert!(
        (found - expected).abs() < tolerance,
        "{found}, expected {expected}"
    );
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]
    #[test]
    fn a_motor_is_found_again(
        speed_deg_s in 4_000.0..20_000.0_f64,
        tau_s in 0.02..0.08_f64,
        friction in 0.02..0.1_f64,
    ) {
        let motor = Motor { speed_deg_s, tau_s, friction, misfit: 0.0 };
        let found = identify(&followed(motor, 0.05, 0.0004), TICK_S).expect("it moves");
        let acceleration = speed_deg_s / tau_s;
        near(found.speed_deg_s / found.tau_s, acceleration, 0.01 * acceleration)?;
        near(found.friction, friction, 0.001 + 0.03 * friction)?;
        near(found.tau_s, tau_s, 0.04 * tau_s)?;
    }
}

const MOTOR: Motor = Motor {
    speed_deg_s: 12_000.0,
    tau_s: 0.048,
    friction: 0.05,
    misfit: 0.0,
};

#[test]
fn a_whisker_that_stands_or_does_not_obey_its_duty_has_no_motor() {
    let mut samples = followed(MOTOR, 0.05, 0.0004);
    assert!(identify(&samples, TICK_S).is_some());
    for sample in &mut samples {
        sample.duty = -sample.duty;
    }
    assert_eq!(identify(&samples, TICK_S), None);
    for sample in &mut samples {
        sample.measured_deg = 50.0;
    }
    assert_eq!(identify(&samples, TICK_S), None);
}

#[test]
fn what_is_suggested_is_damped_and_leaves_less() {
    let (now, better) = (MOTOR.under(0.05, 0.0004), suggest(&MOTOR, TICK_S));
    assert!((now.dead_band_deg - 1.0).abs() < 1e-12);
    // (1 + 4.8)/(2 √(600 · 0.048)).
    assert!((now.damping - 0.540).abs() < 0.001, "{now:?}");
    assert!((better.damping - 0.8).abs() < 0.05, "{better:?}");
    assert!(better.dead_band_deg < 0.75, "{better:?}");
}
