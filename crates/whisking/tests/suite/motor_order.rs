//! The order of writes across pins, which separate mocks cannot see: all pins
//! of a driver write into one log, and the log is compared word for word.

use crate::pins::{FREE_RUNNING, Log, MAX, Wire};
use proptest::prelude::*;
use whisking::motor::{Duty, HBridge, MotorDriver, SixStep};

const HALF: Duty = Duty::from_q15(16_384);
const MINUS_HALF: Duty = Duty::from_q15(-16_384);
/// The writes that switch the six-step stage off.
const OFF: &str = "EN1=0 EN2=0 EN3=0 IN1=0 IN2=0 IN3=0";

struct Bench<D> {
    log: Log,
    driver: D,
    halls: [Wire; 3],
}

impl<D: MotorDriver> Bench<D> {
    fn drive(&mut self, duty: Duty) -> String {
        self.driver.drive(duty).unwrap();
        self.log.take()
    }

    fn off(&mut self) -> String {
        self.driver.off();
        self.log.take()
    }

    fn turn(&self, code: u16) {
        for (bit, hall) in self.halls.iter().enumerate() {
            hall.value.set(code >> bit & 1);
        }
    }

    fn map(self, change: impl FnOnce(D) -> D) -> Self {
        Self {
            driver: change(self.driver),
            ..self
        }
    }
}

fn bridge() -> Bench<HBridge<Wire, Wire>> {
    let log = Log::default();
    let driver = HBridge::new(Wire::new("PWM", &log), Wire::new("DIR", &log));
    let halls = Default::default();
    Bench { log, driver, halls }
}

type Three = (Wire, Wire, Wire);

fn six_step() -> Bench<SixStep<Three, Three, Three>> {
    let (log, halls) = (Log::default(), <[Wire; 3]>::default());
    let out = |names: [_; 3]| names.map(|name| Wire::new(name, &log)).into();
    let driver = SixStep::new(
        out(["IN1", "IN2", "IN3"]),
        out(["EN1", "EN2", "EN3"]),
        halls.clone().into(),
        FREE_RUNNING,
    );
    let bench = Bench { log, driver, halls };
    bench.turn(1);
    bench
}

#[test]
fn hbridge_reverses_over_zero() {
    let mut bridge = bridge();
    assert_eq!(bridge.log.take(), "PWM=0");
    assert_eq!(bridge.drive(HALF), "PWM=0 DIR=1 PWM=500");
    assert_eq!(bridge.drive(MINUS_HALF), "PWM=0 DIR=0 PWM=500");
    assert_eq!(bridge.drive(MINUS_HALF), "PWM=500");
    assert_eq!(bridge.off(), "PWM=0");
}

#[test]
fn buffered_hbridge_rests_a_tick_before_it_reverses() {
    let mut bridge = bridge().map(HBridge::with_buffered_pwm);
    bridge.log.take();
    assert_eq!(bridge.drive(HALF), "PWM=0 DIR=1 PWM=500");
    assert_eq!(bridge.drive(MINUS_HALF), "PWM=0");
    assert_eq!(bridge.drive(MINUS_HALF), "PWM=0 DIR=0 PWM=500");
    // From rest there is nothing to wait for.
    assert_eq!(bridge.drive(Duty::ZERO), "PWM=0");
    assert_eq!(bridge.drive(HALF), "PWM=0 DIR=1 PWM=500");
}

#[test]
fn six_step_breaks_before_it_makes() {
    let mut motor = six_step();
    assert_eq!(motor.log.take(), OFF);
    // Whatever the outputs are, the first step sets them all.
    let first = "EN1=0 EN2=0 EN3=0 IN1=0 IN3=0 IN2=500 EN3=1 EN2=1";
    assert_eq!(motor.drive(HALF), first);
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
fn buffered_six_step_coasts_a_tick_before_it_reverses() {
    let mut motor = six_step().map(SixStep::with_buffered_pwm);
    motor.drive(HALF);
    assert_eq!(motor.drive(MINUS_HALF), OFF);
    let first = "EN1=0 EN2=0 EN3=0 IN1=0 IN2=0 IN3=500 EN2=1 EN3=1";
    assert_eq!(motor.drive(MINUS_HALF), first);
    // Reverse 1 to 3 (high 3 to 1, low stays 2): no phase goes from high to low.
    motor.turn(3);
    assert_eq!(motor.drive(MINUS_HALF), "EN3=0 IN3=0 IN1=500 EN1=1");
    // After a tick at zero there is nothing to wait for.
    assert_eq!(motor.drive(Duty::ZERO), "IN1=0");
    let forward = "EN1=0 EN2=0 IN1=0 IN2=500 EN1=1 EN2=1";
    assert_eq!(motor.drive(HALF), forward);
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
    #[test]
    fn hbridge_direction_changes_only_at_zero(
        duties in proptest::collection::vec(any::<i16>(), 1..40),
        buffered: bool,
    ) {
        let bridge = bridge();
        let mut bridge = if buffered { bridge.map(HBridge::with_buffered_pwm) } else { bridge };
        let mut now = [0; 3];
        // A buffered timer still puts out, during a tick, what it was left at
        // in the tick before.
        let mut before = 0;
        for q15 in duties {
            let words = bridge.drive(Duty::from_q15(q15));
            let mut old = now;
            for new in states(&words, ["PWM", "DIR", ""], &mut now) {
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
        let mut motor = six_step();
        let (mut en, mut inputs) = ([0; 3], [0; 3]);
        let mut before = None;
        for (sector, q15) in ticks {
            motor.turn([1, 3, 2, 6, 4, 5][sector]);
            let mut passed = Vec::new();
            for word in motor.drive(Duty::from_q15(q15)).split_whitespace() {
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
