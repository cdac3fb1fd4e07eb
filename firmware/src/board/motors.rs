//! The motors that a scene can name: the same on every board.

use whisking::motor::{HBridge, MotorDriver, SixStep, SixStepConfig, StallConfig};

use super::gpio::Pin;
use super::pin_config::{Mode, PinConfig};
use super::pwm::{self, Channel};
use super::wiring::{Direction, Enables, Halls, Pwm1, Pwm2, Pwm3};
use crate::here::{PWM_FUNCTION, free_hall_pins};

/// A pin as output of the PWM timer.
const PWM_PIN: PinConfig = PinConfig::new(Mode::AlternateOutput(PWM_FUNCTION));

/// A motor and its power stage.
pub(crate) trait Motor {
    /// Its type in the library.
    type Driver: MotorDriver;

    /// A motor that is off.
    fn start(stall: StallConfig) -> Self::Driver;
}

/// A brushed motor on an H-bridge.
pub(crate) struct Brushed;

impl Motor for Brushed {
    type Driver = HBridge<Channel<0>, Direction>;

    fn start(_: StallConfig) -> Self::Driver {
        let (pwm, _, _) = pwm::start();
        let motor = HBridge::new(pwm, Direction::new(PinConfig::OUTPUT)).with_buffered_pwm();
        Pwm1::new(PWM_PIN);
        motor
    }
}

/// A brushless motor with Hall sensors on three half-bridges (L6230).
pub(crate) struct Brushless;

impl Motor for Brushless {
    type Driver = SixStep<(Channel<0>, Channel<1>, Channel<2>), Enables, Halls>;

    fn start(stall: StallConfig) -> Self::Driver {
        let config = SixStepConfig {
            stall,
            ..SixStepConfig::DEFAULT
        };
        free_hall_pins();
        let output = PinConfig::OUTPUT;
        let enables = (Pin::new(output), Pin::new(output), Pin::new(output));
        let input = PinConfig::INPUT.pulled_up();
        let halls = (Pin::new(input), Pin::new(input), Pin::new(input));
        let motor = SixStep::new(pwm::start(), enables, halls, config).with_buffered_pwm();
        Pwm1::new(PWM_PIN);
        Pwm2::new(PWM_PIN);
        Pwm3::new(PWM_PIN);
        motor
    }
}
