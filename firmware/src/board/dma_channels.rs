//! DMA with channels (STM32F1, STM32G0): one moves the bytes that the SPI
//! received (rx), one sends it a byte a request (tx). The board's file names them.

use stm32_metapac::DMA1;
use stm32_metapac::bdma::vals::{Dir, Pl};

use crate::here::{RX_DMA, TX_DMA};

/// Sets the addresses of both.
///
/// `received` must have room for as many bytes as each [`start`] moves, and
/// both must be static.
pub(crate) fn set_up(data_register: u32, received: u32, sent: u32) {
    for (channel, memory) in [(RX_DMA, received), (TX_DMA, sent)] {
        DMA1.ch(channel).par().write_value(data_register);
        DMA1.ch(channel).mar().write_value(memory);
    }
}

/// Starts a transfer of `bytes` on both: the rx DMA to successive addresses, the
/// tx DMA always from the same one.
#[inline]
pub(crate) fn start(bytes: u16) {
    // A channel takes a new count only while it is off, and stays on at its end.
    stop();
    DMA1.ifcr().write(|w| {
        for channel in [RX_DMA, TX_DMA] {
            w.set_gif(channel, true);
            w.set_tcif(channel, true);
            w.set_htif(channel, true);
            w.set_teif(channel, true);
        }
    });
    DMA1.ch(RX_DMA).ndtr().write(|w| w.set_ndt(bytes));
    DMA1.ch(RX_DMA).cr().write(|w| {
        w.set_dir(Dir::FROM_PERIPHERAL);
        w.set_minc(true);
        w.set_pl(Pl::VERY_HIGH);
        w.set_tcie(true);
        w.set_teie(true);
        w.set_en(true);
    });
    DMA1.ch(TX_DMA).ndtr().write(|w| w.set_ndt(bytes));
    DMA1.ch(TX_DMA).cr().write(|w| {
        w.set_dir(Dir::FROM_MEMORY);
        w.set_en(true);
    });
}

/// Whether the rx DMA has ended, with or without an error.
#[inline]
pub(crate) fn has_ended() -> bool {
    let flags = DMA1.isr().read();
    flags.tcif(RX_DMA) || flags.teif(RX_DMA)
}

/// Whether the rx DMA has moved all bytes, and neither met an error.
#[inline]
pub(crate) fn is_complete() -> bool {
    let flags = DMA1.isr().read();
    flags.tcif(RX_DMA) && !flags.teif(RX_DMA) && !flags.teif(TX_DMA)
}

/// Acknowledges the interrupt. The flags stay.
#[inline]
pub(crate) fn acknowledge() {
    DMA1.ch(RX_DMA).cr().modify(|w| {
        w.set_tcie(false);
        w.set_teie(false);
    });
}

/// Stops both at once, in the middle of a transfer too.
#[inline]
pub(crate) fn stop() {
    for channel in [RX_DMA, TX_DMA] {
        DMA1.ch(channel).cr().write(|_| {});
    }
}
