//! Pins of chips with a mode, a type, a speed and a function register each (STM32F4, STM32G0).

use stm32_metapac::gpio::Gpio;
use stm32_metapac::gpio::vals::{Moder, Ospeedr, Ot, Pupdr};

use crate::board::pin_config::{Mode, PinConfig, Pull, Speed};

/// The mode register last, so that the pin never drives with half a configuration.
#[inline(never)]
pub(crate) fn configure(port: Gpio, n: usize, config: PinConfig) {
    let (moder, function) = match config.mode {
        Mode::Input => (Moder::INPUT, None),
        Mode::Output => (Moder::OUTPUT, None),
        Mode::AlternateInput(function)
        | Mode::AlternateOutput(function)
        | Mode::AlternateOpenDrain(function) => (Moder::ALTERNATE, Some(function)),
    };
    let pull = match config.pull {
        Pull::Floating => Pupdr::FLOATING,
        Pull::Up => Pupdr::PULL_UP,
    };
    let kind = match config.mode {
        Mode::AlternateOpenDrain(_) => Ot::OPEN_DRAIN,
        _ => Ot::PUSH_PULL,
    };
    let speed = match config.speed {
        Speed::Low => Ospeedr::LOW_SPEED,
        Speed::High => Ospeedr::HIGH_SPEED,
    };
    if let Some(function) = function {
        port.afr(n / 8).modify(|w| w.set_afr(n % 8, function));
    }
    port.pupdr().modify(|w| w.set_pupdr(n, pull));
    port.ospeedr().modify(|w| w.set_ospeedr(n, speed));
    port.otyper().modify(|w| w.set_ot(n, kind));
    port.moder().modify(|w| w.set_moder(n, moder));
}
