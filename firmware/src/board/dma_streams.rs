//! DMA with streams, which end by themselves (STM32F4): one moves the bytes that the SPI
//! received (rx), one sends it a byte a request (tx). The board's file names them.

use stm32_metapac::dma::regs::Ixr;
use stm32_metapac::dma::vals::{Dir, Pl};
use stm32_metapac::dma::{Dma, St};

/// Two streams of one controller, of its first four, each with the channel of its request
/// (RM0390, DMA request mapping).
pub(crate) struct Route {
    pub(crate) dma: Dma,
    /// By the SPI's reception.
    pub(crate) rx: (u8, u8),
    /// By the byte timer's update.
    pub(crate) tx: (u8, u8),
}

pub(crate) struct Transfers {
    dma: Dma,
    rx: Stream,
    tx: Stream,
}

#[derive(Clone, Copy)]
struct Stream {
    registers: St,
    channel: u8,
    /// Where its flags begin in LISR and LIFCR.
    flags: u32,
}

/// Flags of a stream, from where they begin (RM0390, DMA low interrupt status register).
mod flag {
    pub(super) const FIFO_ERROR: u32 = 1;
    pub(super) const MODE_ERROR: u32 = 1 << 2;
    pub(super) const ERROR: u32 = 1 << 3;
    pub(super) const HALF: u32 = 1 << 4;
    pub(super) const COMPLETE: u32 = 1 << 5;
    pub(super) const ALL: u32 = FIFO_ERROR | MODE_ERROR | ERROR | HALF | COMPLETE;
}

impl Stream {
    fn new(dma: Dma, (number, channel): (u8, u8)) -> Self {
        let number = usize::from(number % 4);
        Self {
            registers: dma.st(number),
            channel,
            flags: [0, 6, 16, 22][number],
        }
    }

    #[inline]
    const fn has(self, found: Ixr, flags: u32) -> bool {
        found.0 & flags << self.flags != 0
    }
}

impl Transfers {
    pub(crate) fn new(&Route { dma, rx, tx }: &Route) -> Self {
        let (rx, tx) = (Stream::new(dma, rx), Stream::new(dma, tx));
        Self { dma, rx, tx }
    }

    /// `received` must have room for as many bytes as each [`start`](Self::start) moves, and
    /// both must be static.
    pub(crate) fn set_up(&self, data_register: u32, received: u32, sent: u32) {
        for (stream, memory) in [(&self.rx, received), (&self.tx, sent)] {
            stream.registers.par().write_value(data_register);
            stream.registers.m0ar().write_value(memory);
        }
    }

    /// Starts a transfer of `bytes` on both: the rx DMA to successive addresses, the
    /// tx DMA always from the same one.
    #[inline]
    pub(crate) fn start(&self, bytes: u16) {
        let flags = flag::ALL << self.rx.flags | flag::ALL << self.tx.flags;
        self.dma.ifcr(0).write_value(Ixr(flags));
        let Self { rx, tx, .. } = self;
        rx.registers.ndtr().write(|w| w.set_ndt(bytes));
        rx.registers.cr().write(|w| {
            w.set_chsel(rx.channel);
            w.set_dir(Dir::PERIPHERAL_TO_MEMORY);
            w.set_minc(true);
            w.set_pl(Pl::VERY_HIGH);
            w.set_tcie(true);
            w.set_teie(true);
            w.set_en(true);
        });
        tx.registers.ndtr().write(|w| w.set_ndt(bytes));
        tx.registers.cr().write(|w| {
            w.set_chsel(tx.channel);
            w.set_dir(Dir::MEMORY_TO_PERIPHERAL);
            w.set_en(true);
        });
    }

    #[inline]
    fn flags(&self) -> Ixr {
        self.dma.isr(0).read()
    }

    #[inline]
    pub(crate) fn has_ended(&self) -> bool {
        self.rx.has(self.flags(), flag::COMPLETE | flag::ERROR)
    }

    #[inline]
    pub(crate) fn is_complete(&self) -> bool {
        let flags = self.flags();
        let error = |stream: Stream| stream.has(flags, flag::ERROR | flag::MODE_ERROR);
        self.rx.has(flags, flag::COMPLETE) && !error(self.rx) && !error(self.tx)
    }

    #[inline]
    pub(crate) fn acknowledge(&self) {
        self.rx.registers.cr().modify(|w| {
            w.set_tcie(false);
            w.set_teie(false);
        });
    }

    pub(crate) fn stop(&self) {
        for stream in [&self.rx, &self.tx] {
            let cr = stream.registers.cr();
            cr.write(|_| {});
            // A stream stops after the current byte, some bus cycles. If it does
            // not, the next frame fails.
            let _ = (0..1_000).any(|_| !cr.read().en());
        }
    }
}
