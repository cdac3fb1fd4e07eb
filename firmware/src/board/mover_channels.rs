//! DMA by channels (STM32F1, STM32G0): one collects the bytes that the SPI
//! received, one feeds it one a request. Which two is the board's to say.

use stm32_metapac::DMA1;
use stm32_metapac::bdma::vals::{Dir, Pl};

use crate::here::{COLLECTOR, FEEDER};

/// Tells both where to fetch and where to put.
///
/// `received` must have room for as many bytes as each [`start`] moves, and
/// both must live for ever.
pub(crate) fn set_up(data_register: u32, received: u32, sent: u32) {
    for (channel, memory) in [(COLLECTOR, received), (FEEDER, sent)] {
        DMA1.ch(channel).par().write_value(data_register);
        DMA1.ch(channel).mar().write_value(memory);
    }
}

/// Both move `bytes`: the collector to successive addresses, the feeder always
/// the same one.
#[inline]
pub(crate) fn start(bytes: u16) {
    // A channel takes a new count only while it is off, and stays on at its end.
    stop();
    DMA1.ifcr().write(|w| {
        for channel in [COLLECTOR, FEEDER] {
            w.set_gif(channel, true);
            w.set_tcif(channel, true);
            w.set_htif(channel, true);
            w.set_teif(channel, true);
        }
    });
    DMA1.ch(COLLECTOR).ndtr().write(|w| w.set_ndt(bytes));
    DMA1.ch(COLLECTOR).cr().write(|w| {
        w.set_dir(Dir::FROM_PERIPHERAL);
        w.set_minc(true);
        w.set_pl(Pl::VERY_HIGH);
        w.set_tcie(true);
        w.set_teie(true);
        w.set_en(true);
    });
    DMA1.ch(FEEDER).ndtr().write(|w| w.set_ndt(bytes));
    DMA1.ch(FEEDER).cr().write(|w| {
        w.set_dir(Dir::FROM_MEMORY);
        w.set_en(true);
    });
}

/// Whether the collector has ended, well or not.
#[inline]
pub(crate) fn has_ended() -> bool {
    let flags = DMA1.isr().read();
    flags.tcif(COLLECTOR) || flags.teif(COLLECTOR)
}

/// Whether the collector has moved all, and neither met an error.
#[inline]
pub(crate) fn is_complete() -> bool {
    let flags = DMA1.isr().read();
    flags.tcif(COLLECTOR) && !flags.teif(COLLECTOR) && !flags.teif(FEEDER)
}

/// The interrupt has been seen. The flags stay.
#[inline]
pub(crate) fn acknowledge() {
    DMA1.ch(COLLECTOR).cr().modify(|w| {
        w.set_tcie(false);
        w.set_teie(false);
    });
}

/// Stops both, wherever they are.
#[inline]
pub(crate) fn stop() {
    for channel in [COLLECTOR, FEEDER] {
        DMA1.ch(channel).cr().write(|_| {});
    }
}
