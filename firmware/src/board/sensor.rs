//! Reads an MLX90333's frames without the core: an SPI, whose bytes a timer spaces and DMA moves.
//!
//! Why not by its driver, as a TMAG5170 is (`tilt.rs`): with the gaps that it needs between bytes a
//! frame takes 430 us of the 500 us of a tick at 2 kHz, and three of a TMAG5170 some 25 us. So a
//! tick computes with the frame that ended before it, while the next one comes.
//!
//! Before the first tick there is time: there [`self_test`] reads the sensor by its driver, over
//! the same pins, as tests read a simulated one. So a fault that only the DMA has shows itself.
//!
//! - *slot*: the time from the start of a byte to that of the next. The sensor
//!   needs a gap between bytes, which no SPI controller makes by itself.
//! - *byte timer*: requests the tx DMA once a period; the first request comes one
//!   slot after /SS went low.
//! - *tx DMA*: writes one 0xFF into the SPI's data register at each request.
//! - *rx DMA*: moves each received byte to memory and interrupts after the eighth.
//!
//! [`FrameSource::start`] in a tick starts a frame, [`Frames::end_of_frame`] in the interrupt of
//! the rx DMA raises /SS, and [`FrameSource::take`] in the next tick returns the bytes. They share
//! no state but the hardware's own flags. What differs between chips is in `spi_*.rs`, `dma_*.rs`
//! and `byte_*.rs`.

use core::sync::atomic::{AtomicU8, Ordering, compiler_fence};

use firmware::boards::Pacing;
use firmware::{BusError, FrameSource, SelfTest};
use mlx90333::timing::{SS_LAG_SLOW_NS, SS_LEAD_SLOW_NS};
use mlx90333::{Decoder, FRAME_LEN, MASTER_BYTE, Mlx90333};
use stm32_metapac::spi::vals::Cpha;

use super::blocking_spi::{Device, Wait, Wires, rounds, set_up};
use super::gpio::Pin;
use super::pin_config::{Mode, PinConfig};
use super::wiring::SensorPort;
use crate::here::{byte_request, dma::Transfers, spi};

static SENT: AtomicU8 = AtomicU8::new(MASTER_BYTE);

pub(crate) type Source = Frames;

/// Once the sensors' clocks run.
pub(crate) fn start(port: &'static SensorPort, pace: FramePace) -> Source {
    Frames::new(port, pace)
}

/// Of SPI mode 1. Waits are a driver's, in either of the sensor's modes.
const WIRES: Wires = Wires {
    phase: Cpha::SECOND_EDGE,
    faster: 0,
    lead_rounds: rounds(SS_LEAD_SLOW_NS),
    lag_rounds: rounds(SS_LAG_SLOW_NS),
    // The self-test rests for longer.
    high_rounds: 0,
    // For a byte of 57 us: 140 us or more on every board, and 10 ms at most.
    polls: 10_000,
};

/// Reads the sensor by its driver, before the first tick and after its start-up.
#[inline(never)]
pub(crate) fn self_test(frames: &mut Frames, decoder: Decoder, pacing: Pacing) -> SelfTest {
    let device = Device::start(frames.port, &WIRES);
    let found = SelfTest::of(&mut Mlx90333::new(device, decoder), &mut Wait, pacing);
    set_up(frames.port, &WIRES, true);
    found
}

#[inline]
pub(crate) fn end_of_frame(source: &mut Source) {
    source.end_of_frame();
}

pub(crate) struct Frames {
    port: &'static SensorPort,
    transfers: Transfers,
    running: bool,
    last: u64,
    /// Rounds of delay from the last byte to /SS high.
    lag: u32,
}

#[derive(Clone, Copy)]
pub(crate) struct FramePace {
    /// Counts of the byte timer from the start of a byte to that of the next.
    pub(crate) slot: u16,
    /// Rounds of delay from the last byte to /SS high.
    pub(crate) lag: u32,
}

impl Frames {
    /// Once the sensors' clocks run. The sensor has had its start-up time by the first frame.
    fn new(port: &'static SensorPort, pace: FramePace) -> Self {
        let FramePace { slot, lag } = pace;
        let pins = &port.pins;
        Pin::new_high(pins.select);
        let timer = port.byte_timer;
        timer.psc().write_value(port.byte_timer_divider - 1);
        timer.arr().write(|w| w.set_arr(slot.saturating_sub(1)));
        byte_request::set_up(slot);
        // The divider takes effect with an update.
        timer.egr().write(|w| w.set_ug(true));
        // Pointers have 32 bits on these chips.
        let (received, sent) = (port.received.0.as_ptr() as u32, SENT.as_ptr() as u32);
        let transfers = Transfers::new(&port.dma);
        transfers.set_up(spi::data_register(port.spi), received, sent);
        set_up(port, &WIRES, true);

        // Only now, so that the clock line never carries anything but the clock.
        // A fast edge: a slow one delays the clock that the SPI itself sees and
        // may cost it the last bit (errata sheet of the STM32F4).
        let function = port.function;
        let sck = PinConfig::new(Mode::AlternateOutput(function)).fast();
        let miso = PinConfig::new(Mode::AlternateInput(function));
        let mosi = PinConfig::new(Mode::AlternateOpenDrain(function));
        // A loop: of three calls in a row a program for size makes calls through a pointer.
        for (pin, config) in [(pins.sck, sck), (pins.miso, miso), (pins.mosi, mosi)] {
            Pin::new(pin, config);
        }
        Self {
            port,
            transfers,
            running: false,
            last: 0,
            lag,
        }
    }

    /// A DMA request that is still pending would put a byte before the next frame: it is withdrawn.
    #[inline]
    fn stop(&mut self) {
        let timer = self.port.byte_timer;
        timer.cr1().write(|_| {});
        timer.dier().write(|_| {});
        self.port.pins.select.high();
    }

    /// The rx DMA's interrupt: the frame is complete, or broken.
    #[inline]
    fn end_of_frame(&mut self) {
        if !self.transfers.has_ended() {
            // The interrupt came late, after `start` had begun another frame.
            return;
        }
        cortex_m::asm::delay(self.lag);
        self.stop();
        // The flags stay for `take`; only the interrupt has been served.
        self.transfers.acknowledge();
    }

    #[inline]
    fn is_complete(&self) -> bool {
        let wire = self.port.spi.sr().read();
        self.transfers.is_complete() && !wire.ovr() && !wire.modf()
    }

    #[cold]
    fn abort(&mut self) {
        self.stop();
        self.transfers.stop();
        set_up(self.port, &WIRES, true);
    }
}

impl FrameSource for Frames {
    #[inline]
    fn take(&mut self) -> Result<Option<[u8; FRAME_LEN]>, BusError> {
        if !self.running {
            return Ok(None);
        }
        self.running = false;
        if !self.is_complete() {
            self.abort();
            return Err(BusError);
        }
        // In case the interrupt, and with it `end_of_frame`, is late.
        self.stop();
        compiler_fence(Ordering::Acquire);
        // One by one: a program for size makes loops of what is done to an array.
        let [low, high] = &self.port.received.0;
        let low = u64::from(low.load(Ordering::Relaxed));
        let high = u64::from(high.load(Ordering::Relaxed));
        self.last = high << 32 | low;
        Ok(FrameSource::last(self))
    }

    #[inline]
    fn last(&self) -> Option<[u8; FRAME_LEN]> {
        Some(self.last.to_le_bytes())
    }

    #[inline]
    fn start(&mut self) {
        // A byte left over would come before the first of this frame.
        spi::drain(self.port.spi);
        compiler_fence(Ordering::Release);
        self.transfers.start(FRAME_LEN as u16);
        self.port.pins.select.low();
        let timer = self.port.byte_timer;
        timer.cnt().write(|_| {});
        timer.sr().write(|_| {});
        byte_request::begin(timer);
        timer.cr1().write(|w| w.set_cen(true));
        self.running = true;
    }
}
