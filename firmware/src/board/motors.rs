//! The motors that a scene can name, and their pins: the same on every board.

use whisking::motor::{HBridge, MotorDriver, SixStep, SixStepConfig, StallConfig};

use super::gpio::{A, B, C, Mode, Pin};
use super::pwm::{self, Channel};
use crate::here::{MOTOR_PINS, free_hall_pins};

/// A motor and its power stage.
pub(crate) trait Motor {
    /// Its type in the library.
    type Driver: MotorDriver;

    /// A motor that is off.
    fn start(stall: StallConfig) -> Self::Driver;
}

/// A brushed motor on an H-bridge: PWM on PA8, direction on PB5.
pub(crate) struct Brushed;

impl Motor for Brushed {
    type Driver = HBridge<Channel<0>, Pin<B, 5>>;

    fn start(_: StallConfig) -> Self::Driver {
        let (pwm, _, _) = pwm::start();
        let motor = HBridge::new(pwm, Pin::new(Mode::Output)).with_buffered_pwm();
        Pin::<A, 8>::new(Mode::Drives(MOTOR_PINS));
        motor
    }
}

/// A brushless motor on three half-bridges (L6230): inputs on PA8 to PA10,
/// enables on PC10 to PC12, Hall sensors on PA15, PB3 and PB10.
pub(crate) struct Brushless;

impl Motor for Brushless {
    type Driver = SixStep<
        (Channel<0>, Channel<1>, Channel<2>),
        (Pin<C, 10>, Pin<C, 11>, Pin<C, 12>),
        (Pin<A, 15>, Pin<B, 3>, Pin<B, 10>),
    >;

    fn start(stall: StallConfig) -> Self::Driver {
        let config = SixStepConfig {
            stall,
            ..SixStepConfig::DEFAULT
        };
        free_hall_pins();
        let output = Mode::Output;
        let enables = (Pin::new(output), Pin::new(output), Pin::new(output));
        let input = Mode::InputPulledUp;
        let halls = (Pin::new(input), Pin::new(input), Pin::new(input));
        let motor = SixStep::new(pwm::start(), enables, halls, config).with_buffered_pwm();
        let drives = Mode::Drives(MOTOR_PINS);
        Pin::<A, 8>::new(drives);
        Pin::<A, 9>::new(drives);
        Pin::<A, 10>::new(drives);
        motor
    }
}
