//! SPI controllers that hold one byte (STM32F1, STM32F4).

use stm32_metapac::SPI1;

/// Bytes, each received one a request for the DMA.
pub(crate) fn set_up_bytes() {
    SPI1.cr2().write(|w| w.set_rxdmaen(true));
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
