//! The H-bridge driver against mock pins: every value written, and what
//! remains off after a fault. The order between pins is in `motor_order.rs`.

use embedded_hal_mock::eh1::MockError;
use embedded_hal_mock::eh1::digital::{Mock as Pin, State, Transaction as Set};
use embedded_hal_mock::eh1::pwm::{Mock as Pwm, Transaction as Pulse};
use std::io::ErrorKind;
use whisking::motor::{Duty, Fault, HBridge, MotorDriver};

const HIGH: State = State::High;
const LOW: State = State::Low;

fn broken() -> MockError {
    MockError::Io(ErrorKind::NotConnected)
}

/// Runs `test` on a bridge and checks that exactly these writes were made.
fn with(pulses: &[Pulse], sets: &[Set], test: impl FnOnce(&mut HBridge<Pwm, Pin>)) {
    let (mut pwm, mut pin) = (Pwm::new(pulses), Pin::new(sets));
    let mut bridge = HBridge::new(pwm.clone(), pin.clone());
    test(&mut bridge);
    pwm.done();
    pin.done();
}

#[test]
fn starts_at_zero_and_writes_nothing_else() {
    with(&[Pulse::set_duty_cycle(0)], &[], |bridge| {
        assert_eq!(bridge.fault(), None);
    });
}

#[test]
fn forward_forward_reverse_zero_forward() {
    with(
        &[
            Pulse::set_duty_cycle(0),
            // Forward, half: direction first at zero.
            Pulse::set_duty_cycle(0),
            Pulse::max_duty_cycle(1000),
            Pulse::set_duty_cycle(500),
            // Forward, full: no detour over zero.
            Pulse::max_duty_cycle(1000),
            Pulse::set_duty_cycle(1000),
            // Reverse, a quarter.
            Pulse::set_duty_cycle(0),
            Pulse::max_duty_cycle(1000),
            Pulse::set_duty_cycle(250),
            // Zero keeps the direction.
            Pulse::max_duty_cycle(1000),
            Pulse::set_duty_cycle(0),
            // Reverse again: still no change of direction.
            Pulse::max_duty_cycle(1000),
            Pulse::set_duty_cycle(1000),
        ],
        &[Set::set(HIGH), Set::set(LOW)],
        |bridge| {
            for q15 in [16_384, 32_767, -8_192, 0, i16::MIN] {
                assert_eq!(bridge.drive(Duty::from_q15(q15)), Ok(()));
            }
        },
    );
}

#[test]
fn failing_pin_zeroes_the_pwm_and_holds_until_clear() {
    with(
        &[
            Pulse::set_duty_cycle(0),
            // First drive: zero, the pin fails, off.
            Pulse::set_duty_cycle(0),
            Pulse::set_duty_cycle(0),
            // Second drive: off anew, no duty.
            Pulse::set_duty_cycle(0),
            // After clear.
            Pulse::set_duty_cycle(0),
            Pulse::max_duty_cycle(100),
            Pulse::set_duty_cycle(100),
        ],
        &[Set::set(HIGH).with_error(broken()), Set::set(HIGH)],
        |bridge| {
            assert_eq!(bridge.drive(Duty::FULL), Err(Fault::Pin));
            assert_eq!(bridge.drive(Duty::FULL), Err(Fault::Pin));
            assert_eq!(bridge.fault(), Some(Fault::Pin));
            bridge.clear();
            assert_eq!(bridge.drive(Duty::FULL), Ok(()));
        },
    );
}

#[test]
fn failing_pwm_leaves_the_direction_alone() {
    with(
        &[
            Pulse::set_duty_cycle(0),
            Pulse::set_duty_cycle(0),
            Pulse::max_duty_cycle(100),
            Pulse::set_duty_cycle(100),
            // The reversal fails at its first write, and off fails too.
            Pulse::set_duty_cycle(0).with_error(broken()),
            Pulse::set_duty_cycle(0).with_error(broken()),
            // The next call tries again.
            Pulse::set_duty_cycle(0),
        ],
        &[Set::set(HIGH)],
        |bridge| {
            assert_eq!(bridge.drive(Duty::FULL), Ok(()));
            assert_eq!(bridge.drive(Duty::from_q15(-1)), Err(Fault::Pwm));
            assert_eq!(bridge.drive(Duty::from_q15(-1)), Err(Fault::Pwm));
        },
    );
}

#[test]
fn after_a_fault_the_direction_is_written_again() {
    with(
        &[
            Pulse::set_duty_cycle(0),
            Pulse::set_duty_cycle(0),
            Pulse::max_duty_cycle(100),
            Pulse::set_duty_cycle(100),
            Pulse::max_duty_cycle(100),
            Pulse::set_duty_cycle(100).with_error(broken()),
            Pulse::set_duty_cycle(0),
            Pulse::set_duty_cycle(0),
            Pulse::max_duty_cycle(100),
            Pulse::set_duty_cycle(100),
        ],
        &[Set::set(HIGH), Set::set(HIGH)],
        |bridge| {
            assert_eq!(bridge.drive(Duty::FULL), Ok(()));
            assert_eq!(bridge.drive(Duty::FULL), Err(Fault::Pwm));
            bridge.clear();
            assert_eq!(bridge.drive(Duty::FULL), Ok(()));
        },
    );
}

/// A write that fails may have gone through: the buffered bridge must wait as
/// if it had.
#[test]
fn buffered_bridge_rests_after_a_failed_duty() {
    let (mut pwm, mut pin) = (
        Pwm::new(&[
            Pulse::set_duty_cycle(0),
            // The duty fails, and so does switching off.
            Pulse::set_duty_cycle(0),
            Pulse::max_duty_cycle(100),
            Pulse::set_duty_cycle(100).with_error(broken()),
            Pulse::set_duty_cycle(0).with_error(broken()),
            // After clear: a tick at zero, then the direction.
            Pulse::set_duty_cycle(0),
            Pulse::set_duty_cycle(0),
            Pulse::max_duty_cycle(100),
            Pulse::set_duty_cycle(100),
        ]),
        Pin::new(&[Set::set(HIGH), Set::set(LOW)]),
    );
    let mut bridge = HBridge::new(pwm.clone(), pin.clone()).with_buffered_pwm();
    assert_eq!(bridge.drive(Duty::FULL), Err(Fault::Pwm));
    bridge.clear();
    let full_reverse = Duty::from_q15(-32_767);
    assert_eq!(bridge.drive(full_reverse), Ok(()));
    // Had the pin moved already, the next call would write one duty only.
    assert_eq!(bridge.drive(full_reverse), Ok(()));
    pwm.done();
    pin.done();
}

#[test]
fn off_does_not_fail_but_remembers() {
    with(
        &[
            Pulse::set_duty_cycle(0),
            Pulse::set_duty_cycle(0).with_error(broken()),
            Pulse::set_duty_cycle(0),
        ],
        &[],
        |bridge| {
            bridge.off();
            assert_eq!(bridge.fault(), Some(Fault::Pwm));
            assert_eq!(bridge.drive(Duty::FULL), Err(Fault::Pwm));
        },
    );
}

#[test]
fn a_failing_start_is_told_by_the_first_drive() {
    with(
        &[
            Pulse::set_duty_cycle(0).with_error(broken()),
            Pulse::set_duty_cycle(0),
        ],
        &[],
        |bridge| assert_eq!(bridge.drive(Duty::FULL), Err(Fault::Pwm)),
    );
}

#[test]
fn release_switches_off() {
    let (mut pwm, mut pin) = (Pwm::new(&[]), Pin::new(&[]));
    pwm.update_expectations(&[Pulse::set_duty_cycle(0), Pulse::set_duty_cycle(0)]);
    let _pins = HBridge::new(pwm.clone(), pin.clone()).release();
    pwm.done();
    pin.done();
}
