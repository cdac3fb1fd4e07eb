//! Motor outputs off, from anywhere and without asking anybody.

use stm32_metapac::TIM1;
use stm32_metapac::gpio::Gpio;
use stm32_metapac::timer::vals::Ossi;
use stm32_metapac::{GPIOA, GPIOC};

use super::gpio::Mode;
use crate::here::{clock_ports, gpio::configure};

/// The PWM pins PA8 to PA10, and the enables PC10 to PC12: the same on every board.
const PINS: [(Gpio, usize); 6] = [
    (GPIOA, 8),
    (GPIOA, 9),
    (GPIOA, 10),
    (GPIOC, 10),
    (GPIOC, 11),
    (GPIOC, 12),
];

/// Takes all motor outputs of the board low: the PWM pins PA8 to PA10 and the
/// enables PC10 to PC12. The pins become plain outputs, so that no timer can
/// raise them again.
///
/// For the start and for fault handlers: no locks, nothing that can fail, and
/// calling it again changes nothing. The motor drivers do not know of it:
/// after it the chip must start anew.
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
    for (port, n) in PINS {
        port.bsrr().write(|w| w.set_br(n, true));
        configure(port, n, Mode::Output);
    }
}
