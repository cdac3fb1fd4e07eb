//! The supply of an STM32G0: its voltage detector (RM0444, chapter 4.2.2).

use stm32_metapac::{EXTI, PWR, RCC};

use crate::board::reset::settle;
use crate::board::supply::LINE;

/// Threshold of the detector: about 2.9 V as the supply falls, about 3.0 V as it rises (PVDFT and
/// PVDRT = 110; DS12232, reset and power control block). 64 MHz need 1.7 V, as the wait states do
/// not depend on it in the regulator's range 1 (RM0444, chapter 3.3.4), and the board has 3.3 V.
const LEVEL: u8 = 6;

pub(crate) fn start() {
    RCC.apbenr1().modify(|w| w.set_pwren(true));
    settle();
    PWR.cr2().modify(|w| {
        w.set_pvdft(LEVEL);
        w.set_pvdrt(LEVEL);
        w.set_pvde(true);
    });
}

pub(crate) fn is_low() -> bool {
    PWR.sr2().read().pvdo()
}

pub(crate) fn has_fallen() -> bool {
    EXTI.rpr(0).read().line(LINE)
}

pub(crate) fn forget() {
    EXTI.rpr(0).write(|w| w.set_line(LINE, true));
}

/// The chip works down to its power-down reset (DS12232), whatever the brown-out level.
pub(crate) const fn brown_out_is_low() -> bool {
    false
}
