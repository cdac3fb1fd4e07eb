//! The brushless motor turned by the real six-step driver.

use firmware::AngleInput;
use proptest::prelude::*;
use whisking::motor::{Duty, Fault, MotorDriver, SixStep, SixStepConfig};

use super::tests::any_settings;
use super::{MotorSettings, SimEncoder, SimHall, SimMotor, SimPin, SimPwm, Wire};

type Driver = SixStep<SimPwm, SimPin, SimHall>;

fn motor(settings: MotorSettings) -> (SimMotor, Driver, SimEncoder) {
    let (motor, pins) = SimMotor::brushless(settings).unwrap();
    let config = SixStepConfig::DEFAULT;
    let driver = SixStep::new(pins.pwms, pins.enables, pins.halls, config);
    (motor, driver, pins.encoder)
}

fn run(motor: &mut SimMotor, driver: &mut Driver, duty: Duty, ticks: u32) -> Result<(), Fault> {
    for _ in 0..ticks {
        driver.drive(duty)?;
        motor.advance(5e-5);
    }
    Ok(())
}

#[test]
fn it_spins_both_ways_near_the_speed_of_a_brushed_one() {
    let speeds = [16_384, -16_384].map(|q15| {
        let (mut motor, mut driver, mut encoder) = motor(MotorSettings::DEFAULT);
        run(&mut motor, &mut driver, Duty::from_q15(q15), 20_000).unwrap();
        let turns = (motor.angle_deg() - 50.0) * 11.0 / 360.0;
        // Six sectors and 512 counts a turn; the driver last looked a tick ago.
        assert!((f64::from(driver.counts()) - 6.0 * turns).abs() < 1.5);
        assert!((f64::from(encoder.counts()) - 512.0 * turns).abs() <= 0.5 + 1e-6);
        motor.speed_deg_s()
    });
    // A torque factor that falls to sin 60° between commutations lets the motor
    // turn up to 1/sin 60° faster than one of constant k: (U/2 k/R − τ_c)/(k²/R + b).
    let k = 2.5e-3_f64;
    let brushed = (k * 3.0 / 25.0 - 3e-5) / (k * k / 25.0 + 1e-9) / 11.0;
    let ratio = speeds[0] / brushed.to_degrees();
    assert!((1.0..1.155).contains(&ratio), "{ratio}");
    assert!((speeds[1] / speeds[0] + 1.0).abs() < 0.02, "{speeds:?}");
}

#[test]
fn standing_torque_is_that_of_two_phases() {
    let (mut motor, mut driver, _) = motor(MotorSettings::DEFAULT);
    driver.drive(Duty::FULL).unwrap();
    // The rotor at 0° wants the field at 90°, which is a lead of exactly 90°: full torque of
    // 0.24 A in through phase 2 and out of 3, for a time too short to turn far.
    motor.advance(1e-5);
    let acceleration = (2.5e-3 * 0.24 - 3e-5) / motor.settings().inertia_kg_m2();
    let expected = (acceleration * 1e-5 / 11.0).to_degrees();
    assert!((motor.speed_deg_s() / expected - 1.0).abs() < 1e-3);
    driver.off();
    assert_eq!(motor.effort(), 0.0);
}

#[test]
fn faults_are_seen_by_the_driver() {
    let (mut turning, mut driver, _) = motor(MotorSettings::DEFAULT);
    run(&mut turning, &mut driver, Duty::FULL, 100).unwrap();
    turning.cut(Wire::Halls);
    let found = run(&mut turning, &mut driver, Duty::FULL, 1);
    assert_eq!(found, Err(Fault::InvalidHall(7)));
    assert_eq!(turning.effort(), 0.0);
    turning.mend(Wire::Halls);
    driver.clear();
    run(&mut turning, &mut driver, Duty::FULL, 100).unwrap();

    turning.block(true);
    let found = run(&mut turning, &mut driver, Duty::FULL, 500);
    assert_eq!(found, Err(Fault::Stall));

    // At 0° the current goes through phases 2 and 3: without 2 it cannot start.
    let (mut broken, mut driver, _) = motor(MotorSettings::DEFAULT);
    broken.cut(Wire::Winding(1));
    let found = run(&mut broken, &mut driver, Duty::FULL, 500);
    assert_eq!((found, broken.angle_deg()), (Err(Fault::Stall), 50.0));
}

#[test]
fn a_standing_field_pulls_the_rotor_in_at_any_tick() {
    // Without commutation the rotor swings about the field, 90° ahead, and
    // friction and braking bring it to rest near there.
    for tick_s in [5e-5, 5e-4, 5e-3] {
        let (mut motor, mut driver, _) = motor(MotorSettings::DEFAULT);
        driver.drive(Duty::FULL).unwrap();
        for _ in 0..(2.0 / tick_s) as u32 {
            motor.advance(tick_s);
        }
        let electrical = (motor.angle_deg() - 50.0) * 11.0;
        // Friction holds it within asin(0.03/0.6) = 2.9° of the field.
        assert!((electrical - 90.0).abs() < 2.9, "{tick_s}: {electrical}");
        assert_eq!(motor.speed_deg_s(), 0.0);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// No motor, however odd, gains more energy than its supply can give.
    #[test]
    fn energy_is_bounded(
        settings in any_settings(),
        tick_s in prop_oneof![Just(5e-3), Just(5e-5)],
        duties in prop::collection::vec(-32_767_i16..=32_767, 1..20),
    ) {
        let (mut motor, mut driver, _) = motor(settings);
        let mut given = 0.0;
        for duty in duties {
            if driver.drive(Duty::from_q15(duty)).is_err() {
                driver.clear();
            }
            motor.advance(tick_s);
            // Matched: the most that leaves a source of U behind R.
            given += settings.supply_v.powi(2) / (4.0 * settings.resistance_ohm) * tick_s;
            let speed = motor.speed_deg_s().to_radians() * settings.gear;
            let kinetic = 0.5 * settings.inertia_kg_m2() * speed * speed;
            prop_assert!(kinetic <= given * (1.0 + 1e-9), "{kinetic} {given}");
            prop_assert!(motor.angle_deg().is_finite());
        }
    }
}
