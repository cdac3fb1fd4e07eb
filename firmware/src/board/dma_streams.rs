//! DMA with streams, which end by themselves (STM32F4): one moves what comes (rx), one what goes
//! (tx).

use stm32_metapac::dma::regs::{Cr, Ixr};
use stm32_metapac::dma::vals::{Dir, Pl};
use stm32_metapac::dma::{Dma, St};

/// Two streams of one controller, of its first four for a sensor and of its last four for the
/// serial port, each with the channel of its request (RM0390, DMA request mapping).
pub(crate) struct Route {
    pub(crate) dma: Dma,
    /// By reception, of an SPI or a USART.
    pub(crate) rx: (u8, u8),
    /// By the byte timer's update, or by transmission.
    pub(crate) tx: (u8, u8),
}

/// Where a stream's flags begin in LISR, LIFCR, HISR and HIFCR.
const FLAGS_AT: [u32; 4] = [0, 6, 16, 22];

/// Of a sensor: what the SPI received, and a byte a request for it. What each frame takes of
/// registers is put together once.
pub(crate) struct Transfers {
    dma: Dma,
    rx: Stream,
    tx: Stream,
    /// Flags that a frame sets.
    all: Ixr,
    /// Those that say how it went, and of them those of a whole one.
    seen: Ixr,
    whole: Ixr,
    /// One of them ends the reception.
    ends: Ixr,
}

struct Stream {
    registers: St,
    /// What starts it.
    start: Cr,
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
    /// With the place of its flags.
    fn new(dma: Dma, (number, channel): (u8, u8), mut start: Cr) -> (Self, u32) {
        let number = usize::from(number % 4);
        start.set_chsel(channel);
        start.set_en(true);
        let registers = dma.st(number);
        (Self { registers, start }, FLAGS_AT[number])
    }

    #[inline]
    fn start(&self, bytes: u16) {
        self.registers.ndtr().write(|w| w.set_ndt(bytes));
        self.registers.cr().write_value(self.start);
    }
}

impl Transfers {
    /// The rx DMA moves to successive addresses, the tx DMA always from the same one.
    pub(crate) fn new(&Route { dma, rx, tx }: &Route) -> Self {
        let mut receives = Cr(0);
        receives.set_dir(Dir::PERIPHERAL_TO_MEMORY);
        receives.set_minc(true);
        receives.set_pl(Pl::VERY_HIGH);
        receives.set_tcie(true);
        receives.set_teie(true);
        let mut sends = Cr(0);
        sends.set_dir(Dir::MEMORY_TO_PERIPHERAL);
        let (rx, rx_at) = Stream::new(dma, rx, receives);
        let (tx, tx_at) = Stream::new(dma, tx, sends);
        let errors = flag::ERROR | flag::MODE_ERROR;
        let whole = flag::COMPLETE << rx_at;
        Self {
            dma,
            rx,
            tx,
            all: Ixr(flag::ALL << rx_at | flag::ALL << tx_at),
            seen: Ixr(whole | errors << rx_at | errors << tx_at),
            whole: Ixr(whole),
            ends: Ixr(whole | flag::ERROR << rx_at),
        }
    }

    /// `received` has room for as many bytes as each [`start`](Self::start) moves; both are static.
    pub(crate) fn set_up(&self, data_register: u32, received: u32, sent: u32) {
        for (stream, memory) in [(&self.rx, received), (&self.tx, sent)] {
            stream.registers.par().write_value(data_register);
            stream.registers.m0ar().write_value(memory);
        }
    }

    #[inline]
    pub(crate) fn start(&self, bytes: u16) {
        self.dma.ifcr(0).write_value(self.all);
        self.rx.start(bytes);
        self.tx.start(bytes);
    }

    #[inline]
    fn flags(&self) -> Ixr {
        self.dma.isr(0).read()
    }

    #[inline]
    pub(crate) fn has_ended(&self) -> bool {
        self.flags().0 & self.ends.0 != 0
    }

    #[inline]
    pub(crate) fn is_complete(&self) -> bool {
        self.flags().0 & self.seen.0 == self.whole.0
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
            // It stops after the current byte, some bus cycles. If not, the next frame fails.
            let _ = (0..1_000).any(|_| !cr.read().en());
        }
    }
}

/// Of the serial port: a ring is filled with what comes, and a piece of memory sent at a time.
pub(crate) struct SerialTransfers {
    dma: Dma,
    tx: St,
    tx_channel: u8,
    tx_flags: u32,
}

impl SerialTransfers {
    /// Receives from now on into a static ring of so many bytes, and sends to `to`.
    pub(crate) fn start(route: &Route, [from, to]: [u32; 2], ring: u32, bytes: u16) -> Self {
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
            tx_flags: 0x3F << FLAGS_AT[usize::from(route.tx.0 % 4)],
        }
    }

    #[inline]
    pub(crate) fn left(route: &Route) -> u16 {
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
