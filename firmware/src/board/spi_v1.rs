//! SPI controllers that hold one byte (STM32F1, STM32F4).

use stm32_metapac::spi::Spi;

/// Bytes, each received one a request for the DMA.
pub(crate) fn set_up_bytes(spi: Spi) {
    spi.cr2().write(|w| w.set_rxdmaen(true));
}

pub(crate) fn data_register(spi: Spi) -> u32 {
    // Pointers have 32 bits on these chips.
    spi.dr().as_ptr() as u32
}

#[inline]
pub(crate) fn send(spi: Spi, byte: u8) {
    spi.dr().write(|w| w.set_dr(byte.into()));
}

#[inline]
pub(crate) fn receive(spi: Spi) -> u8 {
    spi.dr().read().dr() as u8
}

#[inline]
pub(crate) fn drain(spi: Spi) {
    let _ = spi.dr().read();
}
