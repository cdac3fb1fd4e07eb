//! The supply of an STM32F1: its voltage detector (RM0008, chapter 5.2).

use stm32_metapac::{EXTI, PWR, RCC};

use crate::board::supply::LINE;

/// Threshold of the detector: 2.66 V or more as the supply falls, at most 3.0 V as it rises
/// (PLS = 111; DS5319, reset and power control block). 72 MHz need 2.0 V, as the wait states
/// do not depend on it (RM0008, chapter 3.3.3), and the board has 3.3 V.
const LEVEL: u8 = 7;

pub(crate) fn start() {
    RCC.apb1enr().modify(|w| w.set_pwren(true));
    PWR.cr().modify(|w| {
        w.set_pls(LEVEL);
        w.set_pvde(true);
    });
}

pub(crate) fn is_low() -> bool {
    PWR.csr().read().pvdo()
}

pub(crate) fn has_fallen() -> bool {
    EXTI.pr(0).read().line(LINE)
}

pub(crate) fn forget() {
    EXTI.pr(0).write(|w| w.set_line(LINE, true));
}

/// The power-down reset at 1.8 to 1.96 V, to which the chip works (DS5319), is always there.
pub(crate) const fn brown_out_is_low() -> bool {
    false
}
