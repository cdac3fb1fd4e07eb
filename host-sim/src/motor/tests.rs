//! The brushed motor against closed forms, through the real H-bridge driver.

use firmware::AngleInput;
use proptest::prelude::*;
use whisking::motor::{Duty, HBridge, MotorDriver};

use super::{BadSetting, MotorSettings, SimEncoder, SimMotor, Wire};

type Driver = HBridge<super::SimPwm, super::SimPin>;

const IDEAL: MotorSettings = MotorSettings {
    viscous_nm_s: 0.0,
    coulomb_nm: 0.0,
    ..MotorSettings::DEFAULT
};

fn motor(settings: MotorSettings) -> (SimMotor, Driver, SimEncoder) {
    let (motor, pins) = SimMotor::brushed(settings).unwrap();
    (motor, HBridge::new(pins.pwm, pins.dir), pins.encoder)
}

fn run(settings: MotorSettings, duty: f32, seconds: f64, tick_hz: f64) -> SimMotor {
    let (mut motor, mut driver, _) = motor(settings);
    for _ in 0..(seconds * tick_hz).round() as u32 {
        driver.drive(Duty::from_f32(duty)).unwrap();
        motor.advance(1.0 / tick_hz);
    }
    motor
}

fn close(found: f64, expected: f64, relative: f64) -> bool {
    (found - expected).abs() <= relative * expected.abs()
}

#[test]
fn no_load_speed_and_time_constant_are_the_closed_forms() {
    for duty in [1.0_f32, -0.5] {
        // U/k at the rotor, over the gear; J R/k².
        let full = f64::from(duty) * (6.0_f64 / 2.5e-3 / 11.0).to_degrees();
        let tau_s = (1e-8 + 2.5e-7 / 121.0) * 25.0 / (2.5e-3 * 2.5e-3);
        let settled = run(IDEAL, duty, 40.0 * tau_s, 1e4);
        assert!(close(settled.speed_deg_s(), full, 1e-4));
        let once = run(IDEAL, duty, tau_s, 1.0 / tau_s);
        let expected = full * (1.0 - (-1.0_f64).exp());
        assert!(close(once.speed_deg_s(), expected, 1e-4));
        // ∫ full (1 − e^(−t/τ)) dt over one τ is full τ/e.
        let way = once.angle_deg() - 50.0;
        assert!(close(way, full * tau_s * (-1.0_f64).exp(), 1e-4));
    }
}

#[test]
fn it_comes_to_rest_at_its_end_stops_and_leaves_them() {
    let settings = MotorSettings {
        stops_deg: [30.0, 60.0],
        ..MotorSettings::DEFAULT
    };
    for (duty, stop) in [(1.0, 60.0), (-1.0, 30.0)] {
        let (mut motor, mut driver, _) = motor(settings);
        let mut drive = |motor: &mut SimMotor, duty: f32| {
            for _ in 0..200 {
                driver.drive(Duty::from_f32(duty)).unwrap();
                motor.advance(5e-4);
            }
        };
        drive(&mut motor, duty);
        assert!((motor.angle_deg() - stop).abs() < 1e-9 && motor.speed_deg_s() == 0.0);
        drive(&mut motor, -duty);
        assert!((motor.angle_deg() - (90.0 - stop)).abs() < 1e-9);
    }
}

#[test]
fn the_default_motor_is_fast_enough_and_loses_speed_to_friction() {
    let full = run(MotorSettings::DEFAULT, 1.0, 1.0, 2000.0).speed_deg_s();
    // (k U/R − τ_c)/(k²/R + b) at the rotor.
    let expected = (2.5e-3 * 6.0 / 25.0 - 3e-5) / (2.5e-3 * 2.5e-3 / 25.0 + 1e-9);
    assert!(close(full, (expected / 11.0_f64).to_degrees(), 1e-6));
    assert!(full > 2000.0);
}

#[test]
fn friction_holds_against_less_and_a_load_pulls_through() {
    // Stall torque 0.6 mN·m, friction 0.03: 5 % of duty.
    let angle_deg = |duty| run(MotorSettings::DEFAULT, duty, 1.0, 2000.0).angle_deg();
    assert!(angle_deg(0.049) == 50.0 && angle_deg(-0.051) < 49.0);
    // Undriven, and its winding open: 11 · 0.03 mN·m at the whisker.
    for (load_nm, moves) in [(3.29e-4, false), (-3.31e-4, true)] {
        let (mut motor, _, _) = motor(MotorSettings::DEFAULT);
        motor.cut(Wire::Winding(0));
        motor.set_load_nm(load_nm);
        motor.advance(1.0);
        assert_eq!(motor.angle_deg() < 50.0, moves);
        assert_eq!(motor.angle_deg() == 50.0, !moves);
    }
}

#[test]
fn zero_duty_brakes_and_an_open_wire_coasts() {
    let coast = |cut: bool| {
        let (mut motor, mut driver, _) = motor(IDEAL);
        driver.drive(Duty::FULL).unwrap();
        motor.advance(0.1);
        let before = motor.speed_deg_s();
        driver.off();
        if cut {
            motor.cut(Wire::Winding(1));
        }
        motor.advance(0.048);
        motor.speed_deg_s() / before
    };
    let tau_s = IDEAL.inertia_kg_m2() * 25.0 / (2.5e-3 * 2.5e-3);
    assert!(close(coast(false), (-0.048 / tau_s).exp(), 1e-9));
    assert_eq!(coast(true), 1.0);
}

#[test]
fn a_blocked_rotor_stays_and_starts_again() {
    let (mut motor, mut driver, _) = motor(MotorSettings::DEFAULT);
    driver.drive(Duty::from_q15(-32_767)).unwrap();
    motor.advance(0.1);
    motor.block(true);
    motor.advance(0.1);
    let held = motor.angle_deg();
    motor.advance(0.1);
    assert_eq!((motor.angle_deg(), motor.speed_deg_s()), (held, 0.0));
    motor.block(false);
    motor.advance(0.1);
    assert!(motor.angle_deg() < held);
}

#[test]
fn the_encoder_counts_up_with_protraction() {
    for duty in [0.4_f32, -0.4] {
        let (mut motor, mut driver, mut encoder) = motor(MotorSettings::DEFAULT);
        assert_eq!(encoder.counts(), 0);
        driver.drive(Duty::from_f32(duty)).unwrap();
        for _ in 0..200 {
            motor.advance(5e-4);
            // 512 counts a motor turn, 11 turns a whisker turn.
            let exact = (motor.angle_deg() - 50.0) / 360.0 * 5632.0;
            assert!((f64::from(encoder.counts()) - exact).abs() <= 0.5 + 1e-9);
        }
        assert!(encoder.counts() as f32 * duty > 400.0);
        let frozen = encoder.counts();
        motor.cut(Wire::Encoder);
        motor.advance(0.1);
        assert_eq!(encoder.counts(), frozen);
        motor.mend(Wire::Encoder);
        motor.advance(0.1);
        assert!((encoder.counts() - frozen) as f32 * duty > 400.0);
    }
}

#[test]
fn bad_settings_are_named() {
    let with = |change: fn(&mut MotorSettings)| {
        let mut settings = MotorSettings::DEFAULT;
        change(&mut settings);
        SimMotor::brushed(settings).map(|_| ()).err()
    };
    assert_eq!(with(|_| ()), None);
    let bad = |name| Some(BadSetting(name));
    assert_eq!(with(|s| s.stops_deg = [60.0, 90.0]), bad("stops_deg"));
    assert_eq!(with(|s| s.gear = 0.5), bad("gear"));
    assert_eq!(with(|s| s.counts_per_rev = 3), bad("counts_per_rev"));
    assert_eq!(with(|s| s.resistance_ohm = 0.0), bad("resistance_ohm"));
    assert_eq!(with(|s| s.rotor_kg_m2 = f64::NAN), bad("rotor_kg_m2"));
}

prop_compose! {
    /// Settings over their whole ranges.
    pub(super) fn any_settings()(
        supply_v in 0.0..100.0_f64,
        powers in prop::array::uniform4(0.0..1.0_f64),
        viscous_nm_s in prop_oneof![Just(0.0), 0.0..1.0_f64],
        coulomb_nm in prop_oneof![Just(0.0), 0.0..10.0_f64],
        gear in 1.0..1000.0_f64,
    ) -> MotorSettings {
        let power = |i: usize, lo: f64, hi: f64| 10_f64.powf(lo + powers[i] * (hi - lo));
        MotorSettings {
            supply_v,
            resistance_ohm: power(0, -2.99, 5.99),
            torque_nm_per_a: power(1, -5.99, 0.99),
            rotor_kg_m2: power(2, -11.99, -0.01),
            whisker_kg_m2: power(3, -12.0, -0.01),
            viscous_nm_s,
            coulomb_nm,
            gear,
            counts_per_rev: 65_536,
            rest_deg: 50.0,
            ..MotorSettings::DEFAULT
        }
    }
}

proptest! {
    /// No motor, however odd, passes its no-load speed at any tick.
    #[test]
    fn speed_is_bounded(
        settings in any_settings(),
        tick_hz in prop_oneof![Just(200.0), Just(20_000.0)],
        duties in prop::collection::vec(-32_767_i16..=32_767, 1..50),
    ) {
        let (mut motor, mut driver, mut encoder) = motor(settings);
        let limit = (settings.supply_v / settings.torque_nm_per_a / settings.gear).to_degrees();
        for duty in duties {
            driver.drive(Duty::from_q15(duty)).unwrap();
            motor.advance(1.0 / tick_hz);
            prop_assert!(motor.speed_deg_s().abs() <= limit * (1.0 + 1e-9));
            prop_assert!(motor.angle_deg().is_finite());
            encoder.counts();
        }
    }

    /// Time and loads that make no sense change nothing.
    #[test]
    fn nonsense_is_ignored(dt in prop_oneof![Just(f64::NAN), Just(f64::INFINITY), -1.0..=0.0]) {
        let (mut motor, mut driver, _) = motor(MotorSettings::DEFAULT);
        driver.drive(Duty::FULL).unwrap();
        motor.set_load_nm(f64::NAN);
        motor.advance(dt);
        prop_assert_eq!(motor.angle_deg(), 50.0);
        motor.advance(0.01);
        prop_assert!(motor.angle_deg() > 50.0);
    }
}

/// With play of three degrees the whisker lags behind its motor by half of that either way.
#[test]
fn a_whisker_lags_within_its_play() {
    let (mut motor, mut driver, mut encoder) = motor(MotorSettings::DEFAULT);
    motor.set_play_deg(3.0);
    let mut most = [0.0_f64; 2];
    for tick in 0..4000 {
        let sign = if tick % 200 < 100 { 1.0 } else { -1.0 };
        driver.drive(Duty::from_f32(0.25 * sign)).unwrap();
        motor.advance(5e-4);
        let turned = f64::from(encoder.counts()) * motor.settings().degrees_per_count();
        let lag = motor.angle_deg() - motor.settings().rest_deg - turned;
        most = [most[0].min(lag), most[1].max(lag)];
    }
    // A count is 0.064 degrees.
    let [back, ahead] = most;
    assert!((back + 1.5).abs() < 0.1 && (ahead - 1.5).abs() < 0.1);
}
