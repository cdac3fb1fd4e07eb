//! The six-step driver against mock pins: exact values, faults, what is tried
//! when a pin fails. The order between pins is in `motor_order.rs`, torque in
//! `motor_rotor.rs`.

use embedded_hal_mock::eh1::MockError;
use embedded_hal_mock::eh1::digital::{Mock as Pin, State, Transaction as Level};
use embedded_hal_mock::eh1::pwm::{Mock as Pwm, Transaction as Pulse};
use std::io::ErrorKind;
use whisking::motor::{
    COMMUTATION, Duty, Fault, MotorDriver, SixStep, SixStepConfig, SixStepState, StallConfig,
    StallGuard,
};

type Motor = SixStep<(Pwm, Pwm, Pwm), (Pin, Pin, Pin), (Pin, Pin, Pin)>;

const HALF: Duty = Duty::from_q15(16_384);

/// What a test expects of nine pins, written down in the order of ticks.
#[derive(Default)]
struct Bench {
    inputs: [Vec<Pulse>; 3],
    enables: [Vec<Level>; 3],
    halls: [Vec<Level>; 3],
}

impl Bench {
    /// A bench that has seen the driver's start.
    fn new() -> Self {
        let mut bench = Self::default();
        bench.off();
        bench
    }

    fn hall(&mut self, code: u8) -> &mut Self {
        for (bit, pin) in self.halls.iter_mut().enumerate() {
            let high = code >> bit & 1 == 1;
            pin.push(Level::get(if high { State::High } else { State::Low }));
        }
        self
    }

    fn enable(&mut self, phase: usize, on: bool) -> &mut Self {
        let state = if on { State::High } else { State::Low };
        self.enables[phase - 1].push(Level::set(state));
        self
    }

    fn zero(&mut self, phase: usize) -> &mut Self {
        self.inputs[phase - 1].push(Pulse::set_duty_cycle(0));
        self
    }

    fn pulse(&mut self, phase: usize, max: u16, duty: u16) -> &mut Self {
        self.inputs[phase - 1].extend([Pulse::max_duty_cycle(max), Pulse::set_duty_cycle(duty)]);
        self
    }

    fn off(&mut self) -> &mut Self {
        for phase in 1..=3 {
            self.enable(phase, false).zero(phase);
        }
        self
    }

    /// The first step after off: all floated, inputs set, the pair raised.
    fn first_step(&mut self, high: usize, low: usize, max: u16, duty: u16) -> &mut Self {
        for phase in 1..=3 {
            self.enable(phase, false);
            if phase != high {
                self.zero(phase);
            }
        }
        self.pulse(high, max, duty)
            .enable(low, true)
            .enable(high, true)
    }

    /// Lets the last write to an enable fail.
    fn break_enable(&mut self, phase: usize) -> &mut Self {
        let last = self.enables[phase - 1].pop().unwrap();
        self.enables[phase - 1].push(last.with_error(broken()));
        self
    }

    /// Lets the last write to a PWM fail.
    fn break_input(&mut self, phase: usize) -> &mut Self {
        let last = self.inputs[phase - 1].pop().unwrap();
        self.inputs[phase - 1].push(last.with_error(broken()));
        self
    }

    /// Runs `test` and checks that exactly the expected happened.
    fn run(&self, config: SixStepConfig, test: impl FnOnce(&mut Motor)) {
        let mut inputs = self.inputs.each_ref().map(Pwm::new);
        let mut enables = self.enables.each_ref().map(Pin::new);
        let mut halls = self.halls.each_ref().map(Pin::new);
        let mut motor = SixStep::new(
            inputs.clone().into(),
            enables.clone().into(),
            halls.clone().into(),
            config,
        );
        test(&mut motor);
        inputs.iter_mut().for_each(Pwm::done);
        enables.iter_mut().for_each(Pin::done);
        halls.iter_mut().for_each(Pin::done);
    }
}

fn broken() -> MockError {
    MockError::Io(ErrorKind::NotConnected)
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
        for (duty, high, low) in [(HALF, high, low), (Duty::from_q15(-16_384), low, high)] {
            let mut bench = Bench::new();
            bench.hall(code).first_step(high, low, 2000, 1000);
            bench.run(SixStepConfig::DEFAULT, |motor| {
                assert_eq!(motor.drive(duty), Ok(()));
                assert_eq!(motor.counts(), 0);
            });
        }
    }
}

#[test]
fn each_channel_is_scaled_to_its_own_range() {
    let mut bench = Bench::new();
    bench.hall(1).first_step(2, 3, 65_535, 65_535);
    // Next sector but one: high moves to phase 3, low to phase 1.
    bench.hall(2).enable(1, true);
    bench.enable(2, false).zero(2).zero(1);
    bench.enable(3, false).pulse(3, 7, 7).enable(3, true);
    bench.run(SixStepConfig::DEFAULT, |motor| {
        assert_eq!(motor.drive(Duty::FULL), Ok(()));
        assert_eq!(motor.drive(Duty::FULL), Ok(()));
        assert_eq!(motor.counts(), 2);
    });
}

#[test]
fn impossible_codes_switch_off_until_clear() {
    for code in [0, 7] {
        let mut bench = Bench::new();
        bench.hall(1).first_step(2, 3, 100, 50);
        bench.hall(code).off();
        // Held off although the sensors are well again, and still counting.
        bench.hall(3).off();
        bench.hall(3).first_step(2, 1, 100, 50);
        bench.run(SixStepConfig::DEFAULT, |motor| {
            assert_eq!(motor.drive(HALF), Ok(()));
            assert_eq!(motor.drive(HALF), Err(Fault::InvalidHall(code)));
            assert_eq!(motor.drive(HALF), Err(Fault::InvalidHall(code)));
            assert_eq!(motor.counts(), 1);
            motor.clear();
            assert_eq!(motor.drive(HALF), Ok(()));
        });
    }
}

#[test]
fn unreadable_sensor_switches_off() {
    let mut bench = Bench::new();
    bench.off();
    bench.halls[0].push(Level::get(State::High).with_error(broken()));
    bench.run(SixStepConfig::DEFAULT, |motor| {
        assert_eq!(motor.drive(HALF), Err(Fault::Pin));
    });
}

#[test]
fn off_tries_every_pin_though_all_fail() {
    let mut bench = Bench::new();
    bench.off();
    for phase in 1..=3 {
        bench.break_enable(phase).break_input(phase);
    }
    bench.run(SixStepConfig::DEFAULT, |motor| {
        motor.off();
        assert_eq!(motor.fault(), Some(Fault::Pin));
    });
}

#[test]
fn a_failing_enable_or_pwm_switches_all_off() {
    // The last enable to rise fails.
    let mut bench = Bench::new();
    bench.hall(1).first_step(2, 3, 100, 50).break_enable(2);
    bench.off();
    bench.run(SixStepConfig::DEFAULT, |motor| {
        assert_eq!(motor.drive(HALF), Err(Fault::Pin));
    });
    // The duty of a later tick fails; the step after clear sets everything.
    let mut bench = Bench::new();
    bench.hall(1).first_step(2, 3, 100, 50);
    bench.hall(1).pulse(2, 100, 50).break_input(2);
    bench.off();
    bench.hall(1).first_step(2, 3, 100, 50);
    bench.run(SixStepConfig::DEFAULT, |motor| {
        assert_eq!(motor.drive(HALF), Ok(()));
        assert_eq!(motor.drive(HALF), Err(Fault::Pwm));
        motor.clear();
        assert_eq!(motor.drive(HALF), Ok(()));
    });
}

#[test]
fn a_failing_start_is_reported_by_the_first_drive() {
    let mut bench = Bench::new();
    bench.break_input(3);
    bench.off().hall(1);
    bench.run(SixStepConfig::DEFAULT, |motor| {
        assert_eq!(motor.drive(HALF), Err(Fault::Pwm));
    });
}

#[test]
fn stall_is_reported_after_the_ticks_and_clear_starts_over() {
    let mut bench = Bench::new();
    bench.hall(1).first_step(2, 3, 100, 50);
    bench.hall(1).pulse(2, 100, 50);
    bench.hall(1).off();
    bench.hall(1).first_step(2, 3, 100, 50);
    bench.run(stall_after(3), |motor| {
        assert_eq!(motor.state(), SixStepState::Off);
        assert_eq!(motor.drive(HALF), Ok(()));
        assert_eq!(motor.drive(HALF), Ok(()));
        let pair = COMMUTATION[0].forward;
        assert_eq!(motor.state(), SixStepState::Driving { pair, duty: HALF });
        assert_eq!(motor.guard(), StallGuard::Still { ticks: 2 });
        assert_eq!(motor.drive(HALF), Err(Fault::Stall));
        let fault = Fault::Stall;
        assert_eq!(motor.state(), SixStepState::Faulted { fault });
        motor.clear();
        assert_eq!(motor.state(), SixStepState::Off);
        assert_eq!(motor.drive(HALF), Ok(()));
    });
}

#[test]
fn a_blocked_rotor_flickering_on_a_hall_edge_is_stalled() {
    let mut bench = Bench::new();
    bench.hall(1).first_step(2, 3, 100, 50);
    bench.hall(3).enable(3, false).zero(1).zero(3);
    bench.pulse(2, 100, 50).enable(1, true);
    bench.hall(1).off();
    bench.run(stall_after(3), |motor| {
        assert_eq!(motor.drive(HALF), Ok(()));
        assert_eq!(motor.drive(HALF), Ok(()));
        assert_eq!(motor.drive(HALF), Err(Fault::Stall));
    });
}

#[test]
fn observing_counts_without_driving() {
    let mut bench = Bench::new();
    for code in [1, 3, 2, 6, 2] {
        bench.hall(code);
    }
    bench.hall(7).off();
    bench.hall(3);
    bench.run(SixStepConfig::DEFAULT, |motor| {
        for counts in [0, 1, 2, 3, 2] {
            assert_eq!(motor.observe(), Ok(()));
            assert_eq!(motor.counts(), counts);
        }
        assert_eq!(motor.observe(), Err(Fault::InvalidHall(7)));
        assert_eq!(motor.observe(), Err(Fault::InvalidHall(7)));
        assert_eq!(motor.counts(), 1);
    });
}

#[test]
fn biotact_resolution() {
    let config = SixStepConfig::DEFAULT;
    assert_eq!(config.counts_per_turn() * 11, 66);
    assert!((config.degrees_per_count(11.0) - 5.4545).abs() < 1e-4);
}
