//! The H-bridge driver: every value written, in its order, and what remains off after a fault.

use crate::pins::{HALF, MINUS_HALF, bridge};
use proptest::prelude::*;
use whisking::motor::{Duty, Fault, HBridge, MotorDriver};

#[test]
fn it_reverses_over_zero() {
    let mut bridge = bridge("");
    assert_eq!(bridge.driver.fault(), None);
    for (q15, written) in [
        (16_384, "PWM=0 DIR=1 PWM=500"),
        // No detour over zero.
        (32_767, "PWM=1000"),
        (-8_192, "PWM=0 DIR=0 PWM=250"),
        // Zero keeps the direction.
        (0, "PWM=0"),
        (i16::MIN, "PWM=1000"),
    ] {
        assert_eq!(bridge.drive(Duty::from_q15(q15)), written);
    }
    assert_eq!(bridge.off(), "PWM=0");
}

#[test]
fn buffered_it_rests_a_tick_before_it_reverses() {
    let mut bridge = bridge("").map(HBridge::with_buffered_pwm);
    assert_eq!(bridge.drive(HALF), "PWM=0 DIR=1 PWM=500");
    assert_eq!(bridge.drive(MINUS_HALF), "PWM=0");
    assert_eq!(bridge.drive(MINUS_HALF), "PWM=0 DIR=0 PWM=500");
    // From rest there is nothing to wait for.
    assert_eq!(bridge.drive(Duty::ZERO), "PWM=0");
    assert_eq!(bridge.drive(HALF), "PWM=0 DIR=1 PWM=500");
}

#[test]
fn failing_pin_zeroes_the_pwm_and_holds_until_clear() {
    let mut bridge = bridge("");
    bridge.fail("DIR", 1);
    assert_eq!(bridge.fails(Duty::FULL), "Pin PWM=0 DIR=1! PWM=0");
    assert_eq!(bridge.fails(Duty::FULL), "Pin PWM=0");
    assert_eq!(bridge.driver.fault(), Some(Fault::Pin));
    bridge.driver.clear();
    assert_eq!(bridge.drive(Duty::FULL), "PWM=0 DIR=1 PWM=1000");
}

#[test]
fn failing_pwm_leaves_the_direction_alone() {
    let mut bridge = bridge("");
    bridge.drive(Duty::FULL);
    // The reversal fails at its first write, and off fails too; the next call tries again.
    bridge.fail("PWM", 0b11);
    let back = Duty::from_q15(-1);
    assert_eq!(bridge.fails(back), "Pwm PWM=0! PWM=0!");
    assert_eq!(bridge.fails(back), "Pwm PWM=0");
}

#[test]
fn after_a_fault_the_direction_is_written_again() {
    let mut bridge = bridge("");
    bridge.drive(Duty::FULL);
    bridge.fail("PWM", 1);
    assert_eq!(bridge.fails(Duty::FULL), "Pwm PWM=1000! PWM=0");
    bridge.driver.clear();
    assert_eq!(bridge.drive(Duty::FULL), "PWM=0 DIR=1 PWM=1000");
}

/// A write that fails may have gone through: the buffered bridge must wait as if it had.
#[test]
fn buffered_bridge_rests_after_a_failed_duty() {
    let mut bridge = bridge("").map(HBridge::with_buffered_pwm);
    // The duty fails, and so does switching off.
    bridge.fail("PWM", 0b110);
    let written = "Pwm PWM=0 DIR=1 PWM=1000! PWM=0!";
    assert_eq!(bridge.fails(Duty::FULL), written);
    bridge.driver.clear();
    assert_eq!(bridge.drive(MINUS_HALF), "PWM=0");
    assert_eq!(bridge.drive(MINUS_HALF), "PWM=0 DIR=0 PWM=500");
}

#[test]
fn off_does_not_fail_but_remembers() {
    let mut bridge = bridge("");
    bridge.fail("PWM", 1);
    assert_eq!(bridge.off(), "PWM=0!");
    assert_eq!(bridge.driver.fault(), Some(Fault::Pwm));
    assert_eq!(bridge.fails(Duty::FULL), "Pwm PWM=0");
}

#[test]
fn a_failing_start_is_reported_by_the_first_drive() {
    assert_eq!(bridge("PWM").fails(Duty::FULL), "Pwm PWM=0");
}

proptest! {
    #[test]
    fn its_direction_changes_only_at_zero(
        duties in proptest::collection::vec(any::<i16>(), 1..40),
        buffered: bool,
    ) {
        let bridge = bridge("");
        let mut bridge = if buffered { bridge.map(HBridge::with_buffered_pwm) } else { bridge };
        let (mut pwm, mut dir) = (0, 0);
        // A buffered timer still puts out, during a tick, what it was left at in the tick before.
        let mut before = 0;
        for q15 in duties {
            for word in bridge.drive(Duty::from_q15(q15)).split_whitespace() {
                let (name, value) = word.split_once('=').unwrap();
                let value: u16 = value.parse().unwrap();
                if name == "PWM" {
                    pwm = value;
                } else if value != dir {
                    dir = value;
                    prop_assert_eq!(pwm, 0);
                    prop_assert!(!buffered || before == 0);
                }
            }
            if pwm > 0 {
                prop_assert_eq!(dir == 1, q15 > 0);
            }
            before = pwm;
        }
    }
}
