//! DMA with channels (STM32F1, STM32G0): one moves what comes (rx), one what goes (tx).

use stm32_metapac::DMA1;
use stm32_metapac::bdma::Ch;
use stm32_metapac::bdma::regs::Isr;
use stm32_metapac::bdma::vals::{Dir, Pl};

pub(crate) struct Route {
    /// Requested by reception, of an SPI or a USART.
    pub(crate) rx: usize,
    /// Requested by the byte timer's update, or by transmission.
    pub(crate) tx: usize,
}

fn channel(number: usize) -> Ch {
    DMA1.ch(number % 7)
}

/// Of a sensor: what the SPI received, and a byte a request for it.
pub(crate) struct Transfers {
    rx: Ch,
    tx: Ch,
    /// Flags that a frame sets.
    all: Isr,
    /// Those that say how it went, and of them those of a whole one.
    seen: Isr,
    whole: Isr,
    /// One of them ends the reception.
    ends: Isr,
}

/// A channel's, from where they begin (RM0008 and RM0444, DMA interrupt status register).
mod flag {
    pub(super) const COMPLETE: u32 = 1 << 1;
    pub(super) const ERROR: u32 = 1 << 3;
    pub(super) const ALL: u32 = 0xF;
}

/// Where a channel's begin.
fn flags_at(number: usize) -> u32 {
    4 * (number % 7) as u32
}

impl Transfers {
    pub(crate) fn new(&Route { rx, tx }: &Route) -> Self {
        let (rx_at, tx_at) = (flags_at(rx), flags_at(tx));
        let whole = flag::COMPLETE << rx_at;
        let ends = whole | flag::ERROR << rx_at;
        Self {
            rx: channel(rx),
            tx: channel(tx),
            all: Isr(flag::ALL << rx_at | flag::ALL << tx_at),
            seen: Isr(ends | flag::ERROR << tx_at),
            whole: Isr(whole),
            ends: Isr(ends),
        }
    }

    /// `received` has room for as many bytes as each [`start`](Self::start) moves; both are static.
    pub(crate) fn set_up(&self, data_register: u32, received: u32, sent: u32) {
        for (channel, memory) in [(&self.rx, received), (&self.tx, sent)] {
            channel.par().write_value(data_register);
            channel.mar().write_value(memory);
        }
    }

    /// The rx DMA moves to successive addresses, the tx DMA always from the same one.
    #[inline]
    pub(crate) fn start(&self, bytes: u16) {
        // A channel takes a new count only while it is off, and stays on at its end.
        self.stop();
        DMA1.ifcr().write_value(self.all);
        let Self { rx, tx, .. } = self;
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
        DMA1.isr().read().0 & self.ends.0 != 0
    }

    #[inline]
    pub(crate) fn is_complete(&self) -> bool {
        DMA1.isr().read().0 & self.seen.0 == self.whole.0
    }

    #[inline]
    pub(crate) fn acknowledge(&self) {
        self.rx.cr().modify(|w| {
            w.set_tcie(false);
            w.set_teie(false);
        });
    }

    #[inline]
    pub(crate) fn stop(&self) {
        for channel in [&self.rx, &self.tx] {
            channel.cr().write(|_| {});
        }
    }
}

/// Of the serial port: a ring is filled with what comes, and a piece of memory sent at a time.
pub(crate) struct SerialTransfers {
    tx: Ch,
}

impl SerialTransfers {
    /// Receives from now on into a static ring of so many bytes, and sends to `to`.
    pub(crate) fn start(route: &Route, [from, to]: [u32; 2], ring: u32, bytes: u16) -> Self {
        let (rx, tx) = (channel(route.rx), channel(route.tx));
        rx.par().write_value(from);
        rx.mar().write_value(ring);
        rx.ndtr().write(|w| w.set_ndt(bytes));
        rx.cr().write(|w| {
            w.set_dir(Dir::FROM_PERIPHERAL);
            w.set_minc(true);
            w.set_circ(true);
            w.set_en(true);
        });
        tx.par().write_value(to);
        Self { tx }
    }

    /// Bytes of the ring that are left until it wraps.
    #[inline]
    pub(crate) fn left(route: &Route) -> u16 {
        channel(route.rx).ndtr().read().ndt()
    }

    /// Whether a piece is under way. It is none after an error, which switches a channel off.
    pub(crate) fn is_sending(&self) -> bool {
        self.tx.cr().read().en() && self.tx.ndtr().read().ndt() != 0
    }

    /// Sends so many bytes from an address, where they must stay until they are sent.
    pub(crate) fn send(&self, address: u32, bytes: u16) {
        // A channel takes address and count only while it is off, and stays on at its end.
        self.tx.cr().write(|_| {});
        self.tx.mar().write_value(address);
        self.tx.ndtr().write(|w| w.set_ndt(bytes));
        self.tx.cr().write(|w| {
            w.set_dir(Dir::FROM_MEMORY);
            w.set_minc(true);
            w.set_en(true);
        });
    }
}
