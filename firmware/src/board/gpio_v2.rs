//! Pins of chips with a mode, a type, a speed and a function register each
//! (STM32F4, STM32G0).

use stm32_metapac::gpio::Gpio;
use stm32_metapac::gpio::vals::{Moder, Ospeedr, Ot, Pupdr};

use crate::board::gpio::Mode;

/// Puts pin `n` of `port`, 0 to 15, into `mode`; the mode register last, so that the pin
/// never drives with half a configuration.
#[inline(never)]
pub(crate) fn configure(port: Gpio, n: usize, mode: Mode) {
    let (moder, function) = match mode {
        Mode::Output => (Moder::OUTPUT, None),
        Mode::InputPulledUp => (Moder::INPUT, None),
        Mode::Drives(function)
        | Mode::DrivesFast(function)
        | Mode::DrivesOpenDrain(function)
        | Mode::Hears(function)
        | Mode::HearsPulledUp(function) => (Moder::ALTERNATE, Some(function)),
    };
    let pull = match mode {
        Mode::InputPulledUp | Mode::HearsPulledUp(_) => Pupdr::PULL_UP,
        _ => Pupdr::FLOATING,
    };
    let kind = match mode {
        Mode::DrivesOpenDrain(_) => Ot::OPEN_DRAIN,
        _ => Ot::PUSH_PULL,
    };
    let speed = match mode {
        Mode::DrivesFast(_) => Ospeedr::HIGH_SPEED,
        _ => Ospeedr::LOW_SPEED,
    };
    if let Some(function) = function {
        port.afr(n / 8).modify(|w| w.set_afr(n % 8, function));
    }
    port.pupdr().modify(|w| w.set_pupdr(n, pull));
    port.ospeedr().modify(|w| w.set_ospeedr(n, speed));
    port.otyper().modify(|w| w.set_ot(n, kind));
    port.moder().modify(|w| w.set_moder(n, moder));
}
