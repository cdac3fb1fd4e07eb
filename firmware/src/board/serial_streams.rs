//! The serial port's DMA with streams (STM32F4): one fills a ring with what comes, one sends
//! a piece of memory at a time.

use stm32_metapac::dma::regs::Ixr;
use stm32_metapac::dma::vals::Dir;
use stm32_metapac::dma::{Dma, St};

/// Two streams of one controller, of its last four, each with the channel of its request
/// (RM0390, DMA request mapping).
pub(crate) struct SerialRoute {
    pub(crate) dma: Dma,
    /// By the USART's reception.
    pub(crate) rx: (u8, u8),
    /// By its transmission.
    pub(crate) tx: (u8, u8),
}

pub(crate) struct SerialTransfers {
    dma: Dma,
    tx: St,
    tx_channel: u8,
    /// The flags of tx in HISR and HIFCR.
    tx_flags: u32,
}

impl SerialTransfers {
    /// Receives from now on from `from` into `ring` of so many bytes, and sends to `to`.
    /// The ring must be static.
    pub(crate) fn start(route: &SerialRoute, [from, to]: [u32; 2], ring: u32, bytes: u16) -> Self {
        let stream = |number: u8| route.dma.st(usize::from(number % 8));
        let (rx, tx) = (stream(route.rx.0), stream(route.tx.0));
        rx.par().write_value(from);
        rx.m0ar().write_value(ring);
        rx.ndtr().write(|w| w.set_ndt(bytes));
        rx.cr().write(|w| {
            w.set_chsel(route.rx.1);
            w.set_dir(Dir::PERIPHERAL_TO_MEMORY);
            w.set_minc(true);
            w.set_circ(true);
            w.set_en(true);
        });
        tx.par().write_value(to);
        Self {
            dma: route.dma,
            tx,
            tx_channel: route.tx.1,
            tx_flags: 0x3F << [0, 6, 16, 22][usize::from(route.tx.0 % 4)],
        }
    }

    #[inline]
    pub(crate) fn left(route: &SerialRoute) -> u16 {
        let rx = route.dma.st(usize::from(route.rx.0 % 8));
        rx.ndtr().read().ndt()
    }

    /// Whether a piece is under way. It is none after an error, which switches a stream off.
    pub(crate) fn is_sending(&self) -> bool {
        self.tx.cr().read().en()
    }

    /// Sends so many bytes from an address, where they must stay until they are sent.
    pub(crate) fn send(&self, address: u32, bytes: u16) {
        // Those of the first four lie before.
        self.dma.ifcr(1).write_value(Ixr(self.tx_flags));
        self.tx.m0ar().write_value(address);
        self.tx.ndtr().write(|w| w.set_ndt(bytes));
        self.tx.cr().write(|w| {
            w.set_chsel(self.tx_channel);
            w.set_dir(Dir::MEMORY_TO_PERIPHERAL);
            w.set_minc(true);
            w.set_en(true);
        });
    }
}
