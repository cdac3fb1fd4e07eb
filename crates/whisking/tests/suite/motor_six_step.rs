//! The six-step driver: every value written, in its order, faults, and what is tried when a pin
//! fails. Torque is in `motor_rotor.rs`.

use crate::pins::{CODES, FREE_RUNNING, HALF, MAX, MINUS_HALF, six_step};
use proptest::prelude::*;
use whisking::motor::{Duty, Fault, MotorDriver, SixStep, SixStepConfig, StallConfig};

/// The writes that switch the stage off.
const OFF: &str = "EN1=0 EN2=0 EN3=0 IN1=0 IN2=0 IN3=0";

/// The first step after off at half drive: all floated, inputs set, the pair raised.
fn first_step(high: usize, low: usize) -> String {
    let others = (1..=3).filter(|&phase| phase != high);
    let zeros: Vec<String> = others.map(|phase| format!("IN{phase}=0")).collect();
    let zeros = zeros.join(" ");
    format!("EN1=0 EN2=0 EN3=0 {zeros} IN{high}=500 EN{low}=1 EN{high}=1")
}

fn off(fault: Fault) -> String {
    format!("{fault:?} {OFF}")
}

fn stall_after(ticks: u16) -> SixStepConfig {
    let threshold = Duty::from_q15(1000);
    SixStepConfig {
        stall: StallConfig { ticks, threshold },
        ..SixStepConfig::DEFAULT
    }
}

/// The table written out by hand: Hall code, high and low phase, both ways.
#[test]
fn each_code_drives_its_pair() {
    for (code, high, low) in [
        (1, 2, 3),
        (3, 2, 1),
        (2, 3, 1),
        (6, 3, 2),
        (4, 1, 2),
        (5, 1, 3),
    ] {
        for (duty, high, low) in [(HALF, high, low), (MINUS_HALF, low, high)] {
            let mut motor = six_step(SixStepConfig::DEFAULT, "");
            motor.turn(code);
            assert_eq!(motor.written(), OFF);
            assert_eq!(motor.drive(duty), first_step(high, low));
            assert_eq!(motor.driver.counts(), 0);
        }
    }
}

#[test]
fn it_breaks_before_it_makes() {
    let mut motor = six_step(FREE_RUNNING, "");
    motor.drive(HALF);
    // Same step: the duty alone.
    assert_eq!(motor.drive(Duty::FULL), "IN2=1000");
    // Next sector: low moves from 3 to 1.
    motor.turn(3);
    assert_eq!(motor.drive(HALF), "EN3=0 IN1=0 IN3=0 IN2=500 EN1=1");
    // Next sector: high moves from 2 to 3.
    motor.turn(2);
    assert_eq!(motor.drive(HALF), "EN2=0 IN2=0 IN3=500 EN3=1");
    // Reversal: both float while their inputs change places.
    let reversal = "EN1=0 EN3=0 IN3=0 IN1=500 EN3=1 EN1=1";
    assert_eq!(motor.drive(MINUS_HALF), reversal);
    // Zero keeps the direction, either one.
    assert_eq!(motor.drive(Duty::ZERO), "IN1=0");
    motor.drive(HALF);
    assert_eq!(motor.drive(Duty::ZERO), "IN3=0");
    assert_eq!(motor.off(), OFF);
}

#[test]
fn buffered_it_coasts_a_tick_before_it_reverses() {
    let mut motor = six_step(FREE_RUNNING, "").map(SixStep::with_buffered_pwm);
    motor.drive(HALF);
    assert_eq!(motor.drive(MINUS_HALF), OFF);
    assert_eq!(motor.drive(MINUS_HALF), first_step(3, 2));
    // Reverse 1 to 3 (high 3 to 1, low stays 2): no phase goes from high to low.
    motor.turn(3);
    assert_eq!(motor.drive(MINUS_HALF), "EN3=0 IN3=0 IN1=500 EN1=1");
    // After a tick at zero there is nothing to wait for.
    assert_eq!(motor.drive(Duty::ZERO), "IN1=0");
    let forward = "EN1=0 EN2=0 IN1=0 IN2=500 EN1=1 EN2=1";
    assert_eq!(motor.drive(HALF), forward);
}

#[test]
fn each_channel_is_scaled_to_its_own_range() {
    let mut motor = six_step(SixStepConfig::DEFAULT, "");
    motor.output("IN2").max.set(Some(65_535));
    motor.output("IN3").max.set(Some(7));
    assert!(motor.drive(Duty::FULL).contains("IN2=65535"));
    // Next sector but one: high moves to phase 3.
    motor.turn(2);
    assert!(motor.drive(Duty::FULL).contains("IN3=7"));
    assert_eq!(motor.driver.counts(), 2);
}

#[test]
fn impossible_codes_switch_off_until_clear() {
    for code in [0, 7] {
        let mut motor = six_step(SixStepConfig::DEFAULT, "");
        motor.drive(HALF);
        motor.turn(code);
        let fault = Fault::InvalidHall(code);
        assert_eq!(motor.fails(HALF), off(fault));
        // Held off although the sensors are well again, and still counting.
        motor.turn(3);
        assert_eq!(motor.fails(HALF), off(fault));
        assert_eq!(motor.driver.counts(), 1);
        motor.driver.clear();
        assert_eq!(motor.drive(HALF), first_step(2, 1));
    }
}

#[test]
fn unreadable_sensor_switches_off() {
    let mut motor = six_step(SixStepConfig::DEFAULT, "");
    motor.written();
    motor.unreadable();
    assert_eq!(motor.fails(HALF), off(Fault::Pin));
}

#[test]
fn off_tries_every_pin_though_all_fail() {
    let mut motor = six_step(SixStepConfig::DEFAULT, "");
    motor.written();
    for name in ["IN1", "IN2", "IN3", "EN1", "EN2", "EN3"] {
        motor.fail(name, 1);
    }
    assert_eq!(motor.off(), "EN1=0! EN2=0! EN3=0! IN1=0! IN2=0! IN3=0!");
    assert_eq!(motor.driver.fault(), Some(Fault::Pin));
}

#[test]
fn a_failing_enable_or_pwm_switches_all_off() {
    // The last enable to rise fails.
    let mut motor = six_step(SixStepConfig::DEFAULT, "");
    motor.written();
    motor.fail("EN2", 0b10);
    let written = format!("Pin {}! {OFF}", first_step(2, 3));
    assert_eq!(motor.fails(HALF), written);
    // The duty of a later tick fails; the step after clear sets everything.
    let mut motor = six_step(SixStepConfig::DEFAULT, "");
    motor.drive(HALF);
    motor.fail("IN2", 1);
    assert_eq!(motor.fails(HALF), format!("Pwm IN2=500! {OFF}"));
    motor.driver.clear();
    assert_eq!(motor.drive(HALF), first_step(2, 3));
}

#[test]
fn a_failing_start_is_reported_by_the_first_drive() {
    let mut motor = six_step(SixStepConfig::DEFAULT, "IN3");
    assert_eq!(motor.written(), format!("{OFF}!"));
    assert_eq!(motor.fails(HALF), off(Fault::Pwm));
}

#[test]
fn stall_is_reported_after_the_ticks_and_clear_starts_over() {
    let mut motor = six_step(stall_after(3), "");
    for _ in 0..2 {
        motor.drive(HALF);
        motor.drive(HALF);
        assert_eq!(motor.fails(HALF), off(Fault::Stall));
        motor.driver.clear();
    }
    assert_eq!(motor.drive(HALF), first_step(2, 3));
}

#[test]
fn a_blocked_rotor_flickering_on_a_hall_edge_is_stalled() {
    let mut motor = six_step(stall_after(3), "");
    for code in [1, 3] {
        motor.turn(code);
        motor.drive(HALF);
    }
    motor.turn(1);
    assert_eq!(motor.fails(HALF), off(Fault::Stall));
}

#[test]
fn clear_allows_the_skips_again() {
    let config = SixStepConfig {
        skip_limit: 2,
        ..SixStepConfig::DEFAULT
    };
    let mut motor = six_step(config, "");
    for code in [1, 2, 4] {
        motor.turn(code);
        motor.drive(HALF);
        motor.driver.clear();
    }
    motor.turn(1);
    motor.drive(HALF);
    motor.turn(2);
    assert_eq!(motor.fails(HALF), off(Fault::SkippedSector));
    assert_eq!(motor.driver.counts(), 8);
}

proptest! {
    /// From write to write the stage drives the old pair, the new pair or
    /// nothing: never a third pair, never two phases high at once.
    #[test]
    fn it_drives_no_pattern_in_between(
        ticks in proptest::collection::vec((0_usize..6, any::<i16>()), 1..40),
    ) {
        let mut motor = six_step(FREE_RUNNING, "");
        motor.written();
        let (mut en, mut inputs) = ([0; 3], [0; 3]);
        let mut before = None;
        for (sector, q15) in ticks {
            motor.turn(CODES[sector]);
            let mut passed = Vec::new();
            for word in motor.drive(Duty::from_q15(q15)).split_whitespace() {
                let (name, value) = word.split_once('=').unwrap();
                let (kind, phase) = name.split_at(2);
                let phase: usize = phase.parse().unwrap();
                let states = if kind == "EN" { &mut en } else { &mut inputs };
                states[phase - 1] = value.parse::<u16>().unwrap();
                let high: Vec<_> = (0..3).filter(|&i| en[i] == 1 && inputs[i] > 0).collect();
                let low: Vec<_> = (0..3).filter(|&i| en[i] == 1 && inputs[i] == 0).collect();
                prop_assert!(high.len() <= 1, "two phases high");
                prop_assert!(high.is_empty() || low.len() <= 1, "two phases low");
                passed.push(high.first().copied().zip(low.first().copied()));
            }
            let after = passed.last().copied().flatten();
            prop_assert_eq!(after.is_some(), Duty::from_q15(q15).scaled_to(MAX) > 0);
            for pair in passed {
                prop_assert!(pair.is_none() || pair == before || pair == after);
            }
            before = after;
        }
    }
}
