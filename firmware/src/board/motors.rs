//! The motors that a scene can name: the same on every board.

use whisking::motor::{HBridge, SixStep, SixStepConfig, StallConfig};

use super::gpio::Pin;
use super::pin_config::{Mode, PinConfig};
use super::pwm::{self, Channel};
use super::wiring::{Direction, Enables, Halls, Pwm1, Pwm2, Pwm3};
use crate::here::{PWM_FUNCTION, free_hall_pins};

/// A pin as output of the PWM timer.
const PWM_PIN: PinConfig = PinConfig::new(Mode::AlternateOutput(PWM_FUNCTION));

/// A brushed motor on an H-bridge.
pub(crate) type Brushed = HBridge<Channel<0>, Direction>;

/// A brushless motor with Hall sensors on three half-bridges (L6230).
pub(crate) type Brushless = SixStep<(Channel<0>, Channel<1>, Channel<2>), Enables, Halls>;

/// A brushed motor that is off.
pub(crate) fn start_brushed() -> Brushed {
    let (pwm, _, _) = pwm::start();
    let motor = HBridge::new(pwm, Direction::new(PinConfig::OUTPUT)).with_buffered_pwm();
    Pwm1::new(PWM_PIN);
    motor
}

/// A brushless motor that is off.
pub(crate) fn start_brushless(stall: StallConfig) -> Brushless {
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
