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

/// What a test expects of the two pins, written down in the order of ticks.
#[derive(Default)]
struct Bench {
    pulses: Vec<Pulse>,
    sets: Vec<Set>,
}

impl Bench {
    /// A bench that has seen the driver's start.
    fn new() -> Self {
        let mut bench = Self::default();
        bench.zero();
        bench
    }

    fn zero(&mut self) -> &mut Self {
        self.pulses.push(Pulse::set_duty_cycle(0));
        self
    }

    fn pulse(&mut self, max: u16, duty: u16) -> &mut Self {
        self.pulses
            .extend([Pulse::max_duty_cycle(max), Pulse::set_duty_cycle(duty)]);
        self
    }

    fn dir(&mut self, state: State) -> &mut Self {
        self.sets.push(Set::set(state));
        self
    }

    /// Lets the last write to the PWM fail.
    fn break_pwm(&mut self) -> &mut Self {
        let last = self.pulses.pop().unwrap();
        self.pulses.push(last.with_error(broken()));
        self
    }

    /// Lets the last write to the pin fail.
    fn break_dir(&mut self) -> &mut Self {
        let last = self.sets.pop().unwrap();
        self.sets.push(last.with_error(broken()));
        self
    }

    /// Runs `test` on a bridge and checks that exactly these writes were made.
    fn run(&self, test: impl FnOnce(HBridge<Pwm, Pin>)) {
        let (mut pwm, mut pin) = (Pwm::new(&self.pulses), Pin::new(&self.sets));
        test(HBridge::new(pwm.clone(), pin.clone()));
        pwm.done();
        pin.done();
    }
}

#[test]
fn starts_at_zero_and_writes_nothing_else() {
    Bench::new().run(|bridge| assert_eq!(bridge.fault(), None));
}

#[test]
fn forward_forward_reverse_zero_forward() {
    let mut bench = Bench::new();
    // Forward, half: direction first at zero.
    bench.zero().dir(HIGH).pulse(1000, 500);
    // Forward, full: no detour over zero.
    bench.pulse(1000, 1000);
    // Reverse, a quarter.
    bench.zero().dir(LOW).pulse(1000, 250);
    // Zero keeps the direction.
    bench.pulse(1000, 0);
    // Reverse again: still no change of direction.
    bench.pulse(1000, 1000);
    bench.run(|mut bridge| {
        for q15 in [16_384, 32_767, -8_192, 0, i16::MIN] {
            assert_eq!(bridge.drive(Duty::from_q15(q15)), Ok(()));
        }
    });
}

#[test]
fn failing_pin_zeroes_the_pwm_and_holds_until_clear() {
    let mut bench = Bench::new();
    // First drive: zero, the pin fails, off.
    bench.zero().dir(HIGH).break_dir().zero();
    // Second drive: off again, no duty.
    bench.zero();
    // After clear.
    bench.zero().dir(HIGH).pulse(100, 100);
    bench.run(|mut bridge| {
        assert_eq!(bridge.drive(Duty::FULL), Err(Fault::Pin));
        assert_eq!(bridge.drive(Duty::FULL), Err(Fault::Pin));
        assert_eq!(bridge.fault(), Some(Fault::Pin));
        bridge.clear();
        assert_eq!(bridge.drive(Duty::FULL), Ok(()));
    });
}

#[test]
fn failing_pwm_leaves_the_direction_alone() {
    let mut bench = Bench::new();
    bench.zero().dir(HIGH).pulse(100, 100);
    // The reversal fails at its first write, and off fails too.
    bench.zero().break_pwm().zero().break_pwm();
    // The next call tries again.
    bench.zero();
    bench.run(|mut bridge| {
        assert_eq!(bridge.drive(Duty::FULL), Ok(()));
        assert_eq!(bridge.drive(Duty::from_q15(-1)), Err(Fault::Pwm));
        assert_eq!(bridge.drive(Duty::from_q15(-1)), Err(Fault::Pwm));
    });
}

#[test]
fn after_a_fault_the_direction_is_written_again() {
    let mut bench = Bench::new();
    bench.zero().dir(HIGH).pulse(100, 100);
    bench.pulse(100, 100).break_pwm().zero();
    bench.zero().dir(HIGH).pulse(100, 100);
    bench.run(|mut bridge| {
        assert_eq!(bridge.drive(Duty::FULL), Ok(()));
        assert_eq!(bridge.drive(Duty::FULL), Err(Fault::Pwm));
        bridge.clear();
        assert_eq!(bridge.drive(Duty::FULL), Ok(()));
    });
}

/// A write that fails may have gone through: the buffered bridge must wait as
/// if it had.
#[test]
fn buffered_bridge_rests_after_a_failed_duty() {
    let mut bench = Bench::new();
    // The duty fails, and so does switching off.
    bench.zero().dir(HIGH).pulse(100, 100).break_pwm();
    bench.zero().break_pwm();
    // After clear: a tick at zero, then the direction.
    bench.zero().zero().dir(LOW).pulse(100, 100);
    bench.run(|bridge| {
        let mut bridge = bridge.with_buffered_pwm();
        assert_eq!(bridge.drive(Duty::FULL), Err(Fault::Pwm));
        bridge.clear();
        let full_reverse = Duty::from_q15(-32_767);
        assert_eq!(bridge.drive(full_reverse), Ok(()));
        // Had the pin moved already, the next call would write one duty only.
        assert_eq!(bridge.drive(full_reverse), Ok(()));
    });
}

#[test]
fn off_does_not_fail_but_remembers() {
    Bench::new().zero().break_pwm().zero().run(|mut bridge| {
        bridge.off();
        assert_eq!(bridge.fault(), Some(Fault::Pwm));
        assert_eq!(bridge.drive(Duty::FULL), Err(Fault::Pwm));
    });
}

#[test]
fn a_failing_start_is_reported_by_the_first_drive() {
    let mut bench = Bench::new();
    bench.break_pwm().zero();
    bench.run(|mut bridge| assert_eq!(bridge.drive(Duty::FULL), Err(Fault::Pwm)));
}

#[test]
fn release_switches_off() {
    Bench::new().zero().run(|bridge| drop(bridge.release()));
}
