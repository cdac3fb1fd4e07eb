//! The motors that a scene can name: the same on every board.

use whisking::motor::{HBridge, SixStep, SixStepConfig, StallConfig};

use super::gpio::{Pin, PinName};
use super::pin_config::{Mode, PinConfig};
use super::pwm::Channel;
use super::wiring::{ENABLES, HALLS, Output, PWMS, Side};
use crate::here::{PWM_FUNCTION, free_hall_pins};

/// A pin as output of the PWM timer.
const PWM_PIN: PinConfig = PinConfig::new(Mode::AlternateOutput(PWM_FUNCTION));

/// A brushed motor on an H-bridge.
pub(crate) type Brushed = HBridge<Channel, Pin>;

/// A brushless motor with Hall sensors on three half-bridges (L6230).
pub(crate) type Brushless = SixStep<(Channel, Channel, Channel), (Pin, Pin, Pin), (Pin, Pin, Pin)>;

/// A brushed motor that is off.
pub(crate) fn start_brushed(side: &Side) -> Brushed {
    let bridge = &side.bridge;
    let direction = Pin::new(bridge.direction, PinConfig::OUTPUT);
    let motor = HBridge::new(Channel::of(bridge.output), direction).with_buffered_pwm();
    Pin::new(bridge.pwm, PWM_PIN);
    motor
}

/// A brushless motor that is off. It takes every output of the timer, so there is one.
pub(crate) fn start_brushless(stall: StallConfig) -> Brushless {
    let config = SixStepConfig {
        stall,
        ..SixStepConfig::DEFAULT
    };
    let pins = |names: [PinName; 3], config| {
        let [a, b, c] = names.map(|name| Pin::new(name, config));
        (a, b, c)
    };
    free_hall_pins();
    let enables = pins(ENABLES, PinConfig::OUTPUT);
    let halls = pins(HALLS, PinConfig::INPUT.pulled_up());
    let [a, b, c] = [Output::One, Output::Two, Output::Three].map(Channel::of);
    let motor = SixStep::new((a, b, c), enables, halls, config).with_buffered_pwm();
    pins(PWMS, PWM_PIN);
    motor
}
