//! Switches the motor outputs off, from anywhere, without locks.

use stm32_metapac::TIM1;
use stm32_metapac::timer::vals::Ossi;

use super::pin_config::PinConfig;
use super::wiring::{ENABLES, PWMS};
use crate::here::clock_ports;

/// Takes all motor outputs of the board low, of either side: the PWMs and the enables.
/// The pins become plain outputs, so that no timer can raise them again.
///
/// No locks, nothing that can fail; again it changes nothing. After it the chip must be reset.
#[inline(never)]
pub(crate) fn off() {
    // No main output, and no automatic return of it: the timer's outputs go to
    // their idle level, low. Without a clock TIM1 ignores this.
    TIM1.bdtr().modify(|w| {
        w.set_aoe(false);
        w.set_moe(false);
        w.set_ossi(Ossi::IDLE_LEVEL);
    });
    clock_ports();
    for pin in [PWMS, ENABLES].as_flattened() {
        pin.low();
        pin.configure(PinConfig::OUTPUT);
    }
}
