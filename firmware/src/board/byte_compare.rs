//! TIM4, the byte timer, requests a byte whenever its count is that of channel 1, once a
//! period like an update (STM32F103). The update's request comes to the DMA channel that
//! the serial port sends by (RM0008, table 78).

use stm32_metapac::TIM4;
use stm32_metapac::timer::TimBasic;

/// At the last count of a period of `slot_counts`, as it ends.
pub(crate) fn set_up(slot_counts: u16) {
    TIM4.ccr(0)
        .write(|w| w.set_ccr(slot_counts.saturating_sub(1)));
}

#[inline]
pub(crate) fn begin(_: TimBasic) {
    TIM4.dier().write(|w| w.set_ccde(0, true));
}
