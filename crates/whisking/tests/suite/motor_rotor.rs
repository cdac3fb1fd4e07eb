//! The six-step driver turning a simulated rotor: direction of torque, lead of the field.
//!
//! The model knows nothing of the table. A magnet at electrical angle α sets
//! sensor k high where cos(α − 120° (k − 1)) > 0; the field is the sum of the
//! driven phases' axes, plus for a phase at its PWM, minus for one at ground.

use crate::pins::{FREE_RUNNING, MAX, Motor, six_step};
use core::f64::consts::TAU;
use proptest::prelude::*;
use whisking::motor::{Duty, MotorDriver, SixStepConfig};

fn axis(phase: usize) -> f64 {
    TAU * phase as f64 / 3.0
}

impl Motor {
    fn place(&self, angle: f64) {
        for (k, hall) in self.halls.iter().enumerate() {
            hall.value.set(u16::from((angle - axis(k)).cos() > 0.0));
        }
    }

    /// The field's components, for a supply of one: two phases at full drive make a length of √3.
    fn field(&self) -> [f64; 2] {
        let value = |n: usize| self.outputs[n].value.get();
        let enabled = || (0..3).filter(|&k| value(3 + k) != 0);
        let pulse = |k: usize| f64::from(value(k)) / f64::from(MAX);
        let mean = enabled().map(pulse).sum::<f64>() / (enabled().count().max(1)) as f64;
        // Star point at the mean of the driven phases; twice, for ±1.
        enabled().fold([0.0; 2], |[x, y], k| {
            let current = 2.0 * (pulse(k) - mean);
            [x + current * axis(k).cos(), y + current * axis(k).sin()]
        })
    }
}

/// Degrees from the rotor to a field, −180 to 180.
fn lead_deg([x, y]: [f64; 2], angle: f64) -> f64 {
    let lead = (y.atan2(x) - angle).rem_euclid(TAU);
    (if lead > TAU / 2.0 { lead - TAU } else { lead }).to_degrees()
}

/// Whether a field leads (or lags, in reverse) by 60° to 120°.
fn drives(field: [f64; 2], angle: f64, forward: bool) -> bool {
    let sign = if forward { 1.0 } else { -1.0 };
    (59.999..=120.001).contains(&(sign * lead_deg(field, angle)))
}

/// Electrical angle in sectors as the counter sees it: edges at ±30°.
fn sector_number(angle: f64) -> i32 {
    (angle / TAU * 6.0 + 0.5).floor() as i32
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Torque has the sign of the duty and 87 % to 100 % of its peak, for any
    /// angle, duty and number of turns.
    #[test]
    fn field_leads_by_60_to_120_degrees(
        turns in -100.0_f64..100.0,
        q15 in prop_oneof![-32_767_i16..-40, 40_i16..=32_767],
    ) {
        let mut bench = six_step(FREE_RUNNING, "");
        let (angle, duty) = (turns * TAU, Duty::from_q15(q15));
        bench.place(angle);
        bench.driver.drive(duty).unwrap();
        let [x, y] = bench.field();
        prop_assert!(drives([x, y], angle, q15 > 0), "{}", lead_deg([x, y], angle));
        let length = f64::from(duty.scaled_to(MAX)) / f64::from(MAX) * 3.0_f64.sqrt();
        prop_assert!((x.hypot(y) - length).abs() < 1e-9);
    }

    /// A rotor with inertia and friction starts from anywhere, runs the way of the duty without
    /// turning back, reaches the same speed both ways, and the count follows it.
    #[test]
    fn rotor_runs_up_both_ways(start in 0.0..TAU, forward: bool) {
        let mut bench = six_step(SixStepConfig::DEFAULT, "");
        let sign = if forward { 1.0 } else { -1.0 };
        let duty = Duty::from_q15(if forward { 16_384 } else { -16_384 });
        let (mut angle, mut speed) = (start, 0.0_f64);
        // Sectors a tick: ten substeps, friction for about a third of a sector.
        for _ in 0..2000 {
            bench.place(angle);
            bench.driver.drive(duty).unwrap();
            prop_assert_eq!(
                bench.driver.counts(),
                sector_number(angle) - sector_number(start)
            );
            let [x, y] = bench.field();
            for _ in 0..10 {
                let torque = y * angle.cos() - x * angle.sin();
                speed += 0.1 * (0.004 * torque - 0.01 * speed);
                angle += 0.1 * speed;
                prop_assert!(sign * speed > 0.0);
            }
        }
        let reached = sign * speed / TAU * 6.0;
        prop_assert!((0.2..0.4).contains(&reached), "{reached} sectors a tick");
    }
}
