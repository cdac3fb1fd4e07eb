//! The order of writes across pins, which separate mocks cannot see: all pins
//! of a driver write into one log, and the log is compared word for word.

use core::convert::Infallible;
use embedded_hal::digital::{self, InputPin, OutputPin};
use embedded_hal::pwm::{self, SetDutyCycle};
use proptest::prelude::*;
use std::cell::{Cell, RefCell};
use std::rc::Rc;
use whisking::motor::{Duty, HBridge, MotorDriver, SixStep, SixStepConfig, StallConfig};

const MAX: u16 = 1000;

/// What the pins of one driver have done, as words like `EN1=1` or `IN2=500`.
#[derive(Clone, Default)]
struct Log(Rc<RefCell<Vec<String>>>);

impl Log {
    fn write(&self, name: &str, value: u16) {
        self.0.borrow_mut().push(format!("{name}={value}"));
    }

    /// Everything since the last call.
    fn take(&self) -> String {
        self.0.take().join(" ")
    }
}

struct Out(&'static str, Log);

impl digital::ErrorType for Out {
    type Error = Infallible;
}

impl OutputPin for Out {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.1.write(self.0, 0);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.1.write(self.0, 1);
        Ok(())
    }
}

impl pwm::ErrorType for Out {
    type Error = Infallible;
}

impl SetDutyCycle for Out {
    fn max_duty_cycle(&self) -> u16 {
        MAX
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        self.1.write(self.0, duty);
        Ok(())
    }
}

/// One bit of a Hall code set by the test.
struct Hall(Rc<Cell<u8>>, u8);

impl digital::ErrorType for Hall {
    type Error = Infallible;
}

impl InputPin for Hall {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.0.get() & self.1 != 0)
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(self.0.get() & self.1 == 0)
    }
}

fn bridge() -> (Log, HBridge<Out, Out>) {
    let log = Log::default();
    let bridge = HBridge::new(Out("PWM", log.clone()), Out("DIR", log.clone()));
    (log, bridge)
}

type Three = (Out, Out, Out);

type Motor = SixStep<Three, Three, (Hall, Hall, Hall)>;

fn six_step() -> (Log, Rc<Cell<u8>>, Motor) {
    let (log, code) = (Log::default(), Rc::new(Cell::new(1)));
    let out = |name| Out(name, log.clone());
    let hall = |bit| Hall(code.clone(), bit);
    // The tests jump about and stand still as they like.
    let config = SixStepConfig {
        skip_limit: u8::MAX,
        stall: StallConfig {
            ticks: 1,
            threshold: Duty::FULL,
        },
        ..SixStepConfig::DEFAULT
    };
    let motor = SixStep::new(
        (out("IN1"), out("IN2"), out("IN3")),
        (out("EN1"), out("EN2"), out("EN3")),
        (hall(1), hall(2), hall(4)),
        config,
    );
    (log, code, motor)
}

fn half() -> Duty {
    Duty::from_q15(16_384)
}

fn minus_half() -> Duty {
    Duty::from_q15(-16_384)
}

#[test]
fn hbridge_reverses_over_zero() {
    let (log, mut bridge) = bridge();
    assert_eq!(log.take(), "PWM=0");
    bridge.drive(half()).unwrap();
    assert_eq!(log.take(), "PWM=0 DIR=1 PWM=500");
    bridge.drive(minus_half()).unwrap();
    assert_eq!(log.take(), "PWM=0 DIR=0 PWM=500");
    bridge.drive(minus_half()).unwrap();
    assert_eq!(log.take(), "PWM=500");
    bridge.off();
    assert_eq!(log.take(), "PWM=0");
}

#[test]
fn buffered_hbridge_rests_a_tick_before_it_reverses() {
    let (log, bridge) = bridge();
    let mut bridge = bridge.with_buffered_pwm();
    log.take();
    bridge.drive(half()).unwrap();
    assert_eq!(log.take(), "PWM=0 DIR=1 PWM=500");
    bridge.drive(minus_half()).unwrap();
    assert_eq!(log.take(), "PWM=0");
    bridge.drive(minus_half()).unwrap();
    assert_eq!(log.take(), "PWM=0 DIR=0 PWM=500");
    // From rest there is nothing to wait for.
    bridge.drive(Duty::ZERO).unwrap();
    bridge.drive(half()).unwrap();
    assert_eq!(log.take(), "PWM=0 PWM=0 DIR=1 PWM=500");
}

#[test]
fn six_step_breaks_before_it_makes() {
    let (log, code, mut motor) = six_step();
    let off = "EN1=0 EN2=0 EN3=0 IN1=0 IN2=0 IN3=0";
    assert_eq!(log.take(), off);
    // Whatever the outputs are, the first step sets them all.
    motor.drive(half()).unwrap();
    assert_eq!(
        log.take(),
        "EN1=0 EN2=0 EN3=0 IN1=0 IN3=0 IN2=500 EN3=1 EN2=1"
    );
    // Same step: the duty alone.
    motor.drive(Duty::FULL).unwrap();
    assert_eq!(log.take(), "IN2=1000");
    // Next sector: low moves from 3 to 1.
    code.set(3);
    motor.drive(half()).unwrap();
    assert_eq!(log.take(), "EN3=0 IN1=0 IN3=0 IN2=500 EN1=1");
    // Next sector: high moves from 2 to 3.
    code.set(2);
    motor.drive(half()).unwrap();
    assert_eq!(log.take(), "EN2=0 IN2=0 IN3=500 EN3=1");
    // Reversal: both float while their inputs change places.
    motor.drive(minus_half()).unwrap();
    assert_eq!(log.take(), "EN1=0 EN3=0 IN3=0 IN1=500 EN3=1 EN1=1");
    // Zero keeps the direction, either one.
    motor.drive(Duty::ZERO).unwrap();
    assert_eq!(log.take(), "IN1=0");
    motor.drive(half()).unwrap();
    log.take();
    motor.drive(Duty::ZERO).unwrap();
    assert_eq!(log.take(), "IN3=0");
    motor.off();
    assert_eq!(log.take(), off);
}

#[test]
fn buffered_six_step_coasts_a_tick_before_it_reverses() {
    let (log, code, motor) = six_step();
    let mut motor = motor.with_buffered_pwm();
    let off = "EN1=0 EN2=0 EN3=0 IN1=0 IN2=0 IN3=0";
    motor.drive(half()).unwrap();
    log.take();
    motor.drive(minus_half()).unwrap();
    assert_eq!(log.take(), off);
    motor.drive(minus_half()).unwrap();
    assert_eq!(
        log.take(),
        "EN1=0 EN2=0 EN3=0 IN1=0 IN2=0 IN3=500 EN2=1 EN3=1"
    );
    // Reverse 1 to 3 (high 3 to 1, low stays 2): no phase goes from high to low.
    code.set(3);
    motor.drive(minus_half()).unwrap();
    assert_eq!(
        log.take(),
        "EN3=0 IN2=0 IN3=0 IN1=500 EN2=1 EN1=1"
            .replace("EN2=1 ", "")
            .replace("IN2=0 ", "")
    );
    // After a tick at zero there is nothing to wait for.
    motor.drive(Duty::ZERO).unwrap();
    motor.drive(half()).unwrap();
    assert_eq!(log.take(), "IN1=0 EN1=0 EN2=0 IN1=0 IN2=500 EN1=1 EN2=1");
}

/// The last value written to each output, read back from a log.
fn states(words: &str, names: [&str; 3], states: &mut [u16; 3]) -> Vec<[u16; 3]> {
    let mut passed = Vec::new();
    for (name, value) in words.split_whitespace().filter_map(|w| w.split_once('=')) {
        if let Some(i) = names.iter().position(|&n| n == name) {
            states[i] = value.parse().unwrap();
            passed.push(*states);
        }
    }
    passed
}

proptest! {
    /// The direction pin never moves while the PWM is above zero.
    #[test]
    fn hbridge_direction_changes_only_at_zero(
        duties in proptest::collection::vec(any::<i16>(), 1..40),
        buffered: bool,
    ) {
        let (log, bridge) = bridge();
        let mut bridge = if buffered { bridge.with_buffered_pwm() } else { bridge };
        let mut now = [0; 3];
        // A buffered timer still puts out, during a tick, what it was left at
        // in the tick before.
        let mut before = 0;
        for q15 in duties {
            bridge.drive(Duty::from_q15(q15)).unwrap();
            let mut old = now;
            for new in states(&log.take(), ["PWM", "DIR", ""], &mut now) {
                if new[1] != old[1] {
                    prop_assert_eq!(new[0], 0);
                    prop_assert!(!buffered || before == 0);
                }
                old = new;
            }
            if now[0] > 0 {
                prop_assert_eq!(now[1] == 1, q15 > 0);
            }
            before = now[0];
        }
    }

    /// From write to write the stage drives the old pair, the new pair or
    /// nothing: never a third pair, never two phases high at once.
    #[test]
    fn six_step_drives_no_pattern_in_between(
        ticks in proptest::collection::vec((0_usize..6, any::<i16>()), 1..40),
    ) {
        let (log, code, mut motor) = six_step();
        let (mut en, mut inputs) = ([0; 3], [0; 3]);
        let mut before = None;
        for (sector, q15) in ticks {
            code.set([1, 3, 2, 6, 4, 5][sector]);
            motor.drive(Duty::from_q15(q15)).unwrap();
            let mut passed = Vec::new();
            for word in log.take().split_whitespace() {
                states(word, ["EN1", "EN2", "EN3"], &mut en);
                states(word, ["IN1", "IN2", "IN3"], &mut inputs);
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
