//! The user button, which stops the motors and arms them, and what idle asks of the tick.
//!
//! The tick stops motors that are armed as soon as the button is down, and none is armed while it
//! is. Idle finds out what a press is, which arms motors that are not armed.

use embedded_hal::digital::InputPin;
use firmware::{Button, ButtonLimits, design_parameters};

use super::counters::Request;
use super::gpio::Pin;
use super::pace;
use super::pin_config::PinConfig;
use super::wiring::USER_BUTTON;

/// From idle to the tick: motors are to be armed.
pub(crate) static REQUEST: Request = Request::none();

/// From the tick to idle: the button has stopped them.
pub(crate) static HAS_STOPPED: Request = Request::none();

/// Whether it is down now, once it is watched.
#[inline]
pub(crate) fn is_down() -> bool {
    USER_BUTTON.is_low()
}

pub(crate) struct UserButton {
    pin: Pin,
    button: Button,
    limits: ButtonLimits,
}

impl UserButton {
    pub(crate) fn start() -> Self {
        Self {
            pin: Pin::new(USER_BUTTON, PinConfig::INPUT.pulled_up()),
            button: Button::default(),
            limits: design_parameters::button(pace::tick_hz()),
        }
    }

    /// Looks at it, once a tick; whether a press has ended.
    pub(crate) fn is_pressed(&mut self) -> bool {
        if HAS_STOPPED.take() {
            self.button.has_stopped(self.limits);
        }
        let Ok(is_down) = self.pin.is_low();
        self.button.sample(self.limits, is_down)
    }
}
