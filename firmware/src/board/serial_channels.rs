//! The serial port's DMA with channels (STM32F1, STM32G0): one fills a ring with what comes,
//! one sends a piece of memory at a time.

use stm32_metapac::DMA1;
use stm32_metapac::bdma::Ch;
use stm32_metapac::bdma::vals::Dir;

pub(crate) struct SerialRoute {
    /// Requested by the USART's reception.
    pub(crate) rx: usize,
    /// Requested by its transmission.
    pub(crate) tx: usize,
}

pub(crate) struct SerialTransfers {
    tx: Ch,
}

impl SerialTransfers {
    /// Receives from now on from `from` into `ring` of so many bytes, and sends to `to`.
    /// The ring must be static.
    pub(crate) fn start(route: &SerialRoute, [from, to]: [u32; 2], ring: u32, bytes: u16) -> Self {
        // The channels of DMA1 are seven.
        let (rx, tx) = (DMA1.ch(route.rx % 7), DMA1.ch(route.tx % 7));
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

    /// How many bytes of a route's ring are left until it wraps.
    #[inline]
    pub(crate) fn left(route: &SerialRoute) -> u16 {
        DMA1.ch(route.rx % 7).ndtr().read().ndt()
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
