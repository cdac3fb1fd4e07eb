//! DMA with streams, which end by themselves (STM32F4): DMA2 stream 0 moves
//! the bytes that the SPI received (rx), stream 1 sends it one a request (tx).
//!
//! Requests (RM0390, DMA2 request mapping): stream 0 channel 3 is SPI1_RX,
//! stream 1 channel 7 is TIM8_UP.

use stm32_metapac::DMA2;
use stm32_metapac::dma::vals::{Dir, Pl};

const RX_DMA: usize = 0;
const SPI1_RX: u8 = 3;
const TX_DMA: usize = 1;
const TIM8_UP: u8 = 7;

/// Sets the addresses of both.
///
/// `received` must have room for as many bytes as each [`start`] moves, and
/// both must be static.
pub(crate) fn set_up(data_register: u32, received: u32, sent: u32) {
    for (stream, memory) in [(RX_DMA, received), (TX_DMA, sent)] {
        DMA2.st(stream).par().write_value(data_register);
        DMA2.st(stream).m0ar().write_value(memory);
    }
}

/// Starts a transfer of `bytes` on both: the rx DMA to successive addresses, the
/// tx DMA always from the same one.
#[inline]
pub(crate) fn start(bytes: u16) {
    DMA2.ifcr(0).write(|w| {
        for stream in [RX_DMA, TX_DMA] {
            w.set_tcif(stream, true);
            w.set_htif(stream, true);
            w.set_teif(stream, true);
            w.set_dmeif(stream, true);
            w.set_feif(stream, true);
        }
    });
    DMA2.st(RX_DMA).ndtr().write(|w| w.set_ndt(bytes));
    DMA2.st(RX_DMA).cr().write(|w| {
        w.set_chsel(SPI1_RX);
        w.set_dir(Dir::PERIPHERAL_TO_MEMORY);
        w.set_minc(true);
        w.set_pl(Pl::VERY_HIGH);
        w.set_tcie(true);
        w.set_teie(true);
        w.set_en(true);
    });
    DMA2.st(TX_DMA).ndtr().write(|w| w.set_ndt(bytes));
    DMA2.st(TX_DMA).cr().write(|w| {
        w.set_chsel(TIM8_UP);
        w.set_dir(Dir::MEMORY_TO_PERIPHERAL);
        w.set_en(true);
    });
}

/// Whether the rx DMA has ended, with or without an error.
#[inline]
pub(crate) fn has_ended() -> bool {
    let flags = DMA2.isr(0).read();
    flags.tcif(RX_DMA) || flags.teif(RX_DMA)
}

/// Whether the rx DMA has moved all bytes, and neither met an error.
#[inline]
pub(crate) fn is_complete() -> bool {
    let flags = DMA2.isr(0).read();
    let error = |stream| flags.teif(stream) || flags.dmeif(stream);
    flags.tcif(RX_DMA) && !error(RX_DMA) && !error(TX_DMA)
}

/// Acknowledges the interrupt. The flags stay.
#[inline]
pub(crate) fn acknowledge() {
    DMA2.st(RX_DMA).cr().modify(|w| {
        w.set_tcie(false);
        w.set_teie(false);
    });
}

/// Stops both at once, in the middle of a transfer too.
pub(crate) fn stop() {
    for stream in [RX_DMA, TX_DMA] {
        let stream = DMA2.st(stream);
        stream.cr().write(|_| {});
        // A stream stops after the current byte, some bus cycles. If it does
        // not, the next frame fails.
        let _ = (0..1_000).any(|_| !stream.cr().read().en());
    }
}
