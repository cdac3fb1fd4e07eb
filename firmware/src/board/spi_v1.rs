//! SPI controllers that hold one byte (STM32F1, STM32F4).

use stm32_metapac::SPI1;
use stm32_metapac::spi::vals::{Br, Cpha, Mstr};

/// Mode 1, most significant bit first, bytes, the slowest clock
/// ([`SPI_DIVIDER`](crate::board::timing::SPI_DIVIDER)); /SS is ours.
pub(crate) fn set_up() {
    SPI1.cr2().write(|w| w.set_rxdmaen(true));
    SPI1.cr1().write(|w| {
        w.set_mstr(Mstr::MASTER);
        w.set_ssm(true);
        w.set_ssi(true);
        w.set_cpha(Cpha::SECOND_EDGE);
        w.set_br(Br::DIV256);
        w.set_spe(true);
    });
}

/// Where bytes go and come from.
pub(crate) fn data_register() -> u32 {
    // Pointers have 32 bits on these chips.
    SPI1.dr().as_ptr() as u32
}

/// Throws away a byte that was left over.
#[inline]
pub(crate) fn drain() {
    let _ = SPI1.dr().read();
}
