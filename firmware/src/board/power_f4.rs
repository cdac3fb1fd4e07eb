//! An STM32F4's voltage detector and brown-out level (RM0390, chapters 5.2 and 3.8.1).

use stm32_metapac::{EXTI, FLASH, PWR, RCC};

use crate::board::reset::settle;
use crate::board::supply::LINE;

/// Threshold of the detector: 2.85 V or more as the supply falls, at most 3.10 V as it rises
/// (PLS = 110; DS10693, reset and power control block). 144 MHz with four wait states need
/// 2.7 V (RM0390, table 5), and the board has 3.3 V.
const LEVEL: u8 = 6;

/// What the option bytes call the only brown-out level above 2.7 V, 2.75 V or more.
const BROWN_OUT_LEVEL_3: u8 = 0;

pub(crate) fn start() {
    RCC.apb1enr().modify(|w| w.set_pwren(true));
    settle();
    PWR.cr1().modify(|w| {
        w.set_pls(LEVEL);
        w.set_pvde(true);
    });
}

pub(crate) fn is_low() -> bool {
    PWR.csr1().read().pvdo()
}

pub(crate) fn has_fallen() -> bool {
    EXTI.pr(0).read().line(LINE)
}

pub(crate) fn forget() {
    EXTI.pr(0).write(|w| w.set_line(LINE, true));
}

/// Whether a dip that the detector is too slow for may end in no reset.
pub(crate) fn brown_out_is_low() -> bool {
    FLASH.optcr().read().bor_lev() != BROWN_OUT_LEVEL_3
}
