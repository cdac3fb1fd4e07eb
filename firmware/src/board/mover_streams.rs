//! DMA by streams, which end by themselves (STM32F4): DMA2 stream 0 collects
//! the bytes that the SPI received, stream 1 feeds it one a request.
//!
//! Requests (RM0390, DMA2 request mapping): stream 0 channel 3 is SPI1_RX,
//! stream 1 channel 7 is TIM8_UP.

use stm32_metapac::DMA2;
use stm32_metapac::dma::vals::{Dir, Pl};

const COLLECTOR: usize = 0;
const SPI1_RX: u8 = 3;
const FEEDER: usize = 1;
const TIM8_UP: u8 = 7;

/// Tells both where to fetch and where to put.
///
/// `received` must have room for as many bytes as each [`start`] moves, and
/// both must live for ever.
pub(crate) fn set_up(data_register: u32, received: u32, sent: u32) {
    for (stream, memory) in [(COLLECTOR, received), (FEEDER, sent)] {
        DMA2.st(stream).par().write_value(data_register);
        DMA2.st(stream).m0ar().write_value(memory);
    }
}

/// Both move `bytes`: the collector to successive addresses, the feeder always
/// the same one.
#[inline]
pub(crate) fn start(bytes: u16) {
    DMA2.ifcr(0).write(|w| {
        for stream in [COLLECTOR, FEEDER] {
            w.set_tcif(stream, true);
            w.set_htif(stream, true);
            w.set_teif(stream, true);
            w.set_dmeif(stream, true);
            w.set_feif(stream, true);
        }
    });
    DMA2.st(COLLECTOR).ndtr().write(|w| w.set_ndt(bytes));
    DMA2.st(COLLECTOR).cr().write(|w| {
        w.set_chsel(SPI1_RX);
        w.set_dir(Dir::PERIPHERAL_TO_MEMORY);
        w.set_minc(true);
        w.set_pl(Pl::VERY_HIGH);
        w.set_tcie(true);
        w.set_teie(true);
        w.set_en(true);
    });
    DMA2.st(FEEDER).ndtr().write(|w| w.set_ndt(bytes));
    DMA2.st(FEEDER).cr().write(|w| {
        w.set_chsel(TIM8_UP);
        w.set_dir(Dir::MEMORY_TO_PERIPHERAL);
        w.set_en(true);
    });
}

/// Whether the collector has ended, well or not.
#[inline]
pub(crate) fn has_ended() -> bool {
    let flags = DMA2.isr(0).read();
    flags.tcif(COLLECTOR) || flags.teif(COLLECTOR)
}

/// Whether the collector has moved all, and neither met an error.
#[inline]
pub(crate) fn is_complete() -> bool {
    let flags = DMA2.isr(0).read();
    let error = |stream| flags.teif(stream) || flags.dmeif(stream);
    flags.tcif(COLLECTOR) && !error(COLLECTOR) && !error(FEEDER)
}

/// The interrupt has been seen. The flags stay.
#[inline]
pub(crate) fn acknowledge() {
    DMA2.st(COLLECTOR).cr().modify(|w| {
        w.set_tcie(false);
        w.set_teie(false);
    });
}

/// Stops both, wherever they are.
pub(crate) fn stop() {
    for stream in [COLLECTOR, FEEDER] {
        let stream = DMA2.st(stream);
        stream.cr().write(|_| {});
        // A stream stops after the byte in hand, some bus cycles. One that
        // does not is found out by the next frame.
        let _ = (0..1_000).any(|_| !stream.cr().read().en());
    }
}
