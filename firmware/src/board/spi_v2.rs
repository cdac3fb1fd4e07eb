//! SPI controllers with a queue of four bytes (STM32G0).

use stm32_metapac::spi::Spi;
use stm32_metapac::spi::vals::{Ds, Frxth};

pub(crate) fn set_up_bytes(spi: Spi) {
    spi.cr2().write(|w| {
        w.set_ds(Ds::BITS8);
        // Each byte is reported, not each pair.
        w.set_frxth(Frxth::QUARTER);
        w.set_rxdmaen(true);
    });
}

pub(crate) fn data_register(spi: Spi) -> u32 {
    // Pointers have 32 bits on these chips.
    spi.dr8().as_ptr() as u32
}

#[inline]
pub(crate) fn send(spi: Spi, byte: u8) {
    spi.dr8().write_value(byte);
}

#[inline]
pub(crate) fn receive(spi: Spi) -> u8 {
    spi.dr8().read()
}

#[inline]
pub(crate) fn drain(spi: Spi) {
    for _ in 0..4 {
        if spi.sr().read().rxne() {
            let _ = spi.dr8().read();
        }
    }
}
