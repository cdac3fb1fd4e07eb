//! DMA with channels (STM32F1, STM32G0): one moves the bytes that the SPI
//! received (rx), one sends it a byte a request (tx). The board's file names them.

use stm32_metapac::DMA1;
use stm32_metapac::bdma::Ch;
use stm32_metapac::bdma::regs::Isr;
use stm32_metapac::bdma::vals::{Dir, Pl};

pub(crate) struct Route {
    /// Requested by the SPI's reception.
    pub(crate) rx: usize,
    /// Requested by the byte timer's update.
    pub(crate) tx: usize,
}

pub(crate) struct Transfers {
    rx: Channel,
    tx: Channel,
}

#[derive(Clone, Copy)]
struct Channel {
    registers: Ch,
    /// Where its flags begin in ISR and IFCR.
    flags: u32,
}

/// Flags of a channel, from where they begin (RM0008 and RM0444, DMA interrupt status
/// register).
mod flag {
    pub(super) const COMPLETE: u32 = 1 << 1;
    pub(super) const ERROR: u32 = 1 << 3;
    pub(super) const ALL: u32 = 0xF;
}

impl Channel {
    fn new(number: usize) -> Self {
        // The channels of DMA1 are seven.
        let number = number % 7;
        Self {
            registers: DMA1.ch(number),
            flags: 4 * number as u32,
        }
    }

    #[inline]
    const fn has(self, found: Isr, flags: u32) -> bool {
        found.0 & flags << self.flags != 0
    }
}

impl Transfers {
    /// On a route that has its clock.
    pub(crate) fn new(&Route { rx, tx }: &Route) -> Self {
        let (rx, tx) = (Channel::new(rx), Channel::new(tx));
        Self { rx, tx }
    }

    /// `received` must have room for as many bytes as each [`start`](Self::start) moves, and
    /// both must be static.
    pub(crate) fn set_up(&self, data_register: u32, received: u32, sent: u32) {
        for (channel, memory) in [(&self.rx, received), (&self.tx, sent)] {
            channel.registers.par().write_value(data_register);
            channel.registers.mar().write_value(memory);
        }
    }

    /// Starts a transfer of `bytes` on both: the rx DMA to successive addresses, the
    /// tx DMA always from the same one.
    #[inline]
    pub(crate) fn start(&self, bytes: u16) {
        // A channel takes a new count only while it is off, and stays on at its end.
        self.stop();
        let flags = flag::ALL << self.rx.flags | flag::ALL << self.tx.flags;
        DMA1.ifcr().write_value(Isr(flags));
        let (rx, tx) = (self.rx.registers, self.tx.registers);
        rx.ndtr().write(|w| w.set_ndt(bytes));
        rx.cr().write(|w| {
            w.set_dir(Dir::FROM_PERIPHERAL);
            w.set_minc(true);
            w.set_pl(Pl::VERY_HIGH);
            w.set_tcie(true);
            w.set_teie(true);
            w.set_en(true);
        });
        tx.ndtr().write(|w| w.set_ndt(bytes));
        tx.cr().write(|w| {
            w.set_dir(Dir::FROM_MEMORY);
            w.set_en(true);
        });
    }

    /// Whether the rx DMA has ended, with or without an error.
    #[inline]
    pub(crate) fn has_ended(&self) -> bool {
        self.rx.has(DMA1.isr().read(), flag::COMPLETE | flag::ERROR)
    }

    #[inline]
    pub(crate) fn is_complete(&self) -> bool {
        let flags = DMA1.isr().read();
        let error = |channel: Channel| channel.has(flags, flag::ERROR);
        self.rx.has(flags, flag::COMPLETE) && !error(self.rx) && !error(self.tx)
    }

    #[inline]
    pub(crate) fn acknowledge(&self) {
        self.rx.registers.cr().modify(|w| {
            w.set_tcie(false);
            w.set_teie(false);
        });
    }

    #[inline]
    pub(crate) fn stop(&self) {
        for channel in [&self.rx, &self.tx] {
            channel.registers.cr().write(|_| {});
        }
    }
}
