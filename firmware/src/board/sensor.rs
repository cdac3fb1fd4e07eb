//! The sensor's frames, read without the core: an SPI, paced by a timer, moved
//! by DMA.
//!
//! - *slot*: the time from the start of a byte to that of the next. The sensor
//!   needs a gap between bytes, which no SPI controller makes by itself.
//! - *pacer*: a timer. Each of its updates lets the feeder write one 0xFF into
//!   the SPI's data register; the first comes one slot after /SS went low.
//! - *feeder*, *collector*: two channels of a DMA controller. The collector
//!   moves each received byte to memory and interrupts after the eighth.
//!
//! A frame is a matter of some ten register writes: [`Frames::take`] in a tick
//! starts one, [`Frames::end_of_frame`] in the collector's interrupt raises
//! /SS, and the next [`Frames::take`] hands the bytes over. The hardware's own
//! flags are the only state they share. What differs between chips is in
//! `spi_*.rs` and `mover_*.rs`.

use core::sync::atomic::{AtomicU8, AtomicU32, Ordering, compiler_fence};

use firmware::{BusError, FrameSource};
use mlx90333::{FRAME_LEN, MASTER_BYTE};
use stm32_metapac::SPI1;

use super::gpio::{A, B, Mode, Pin};
use crate::here::{PACER, SPI_PINS, clock_sensor, mover, reset_spi, spi};

/// Where the collector puts the bytes, as the words that they are fetched by.
/// Atomic because the DMA writes them behind the compiler's back.
static RECEIVED: [AtomicU32; FRAME_LEN / 4] = [const { AtomicU32::new(0) }; FRAME_LEN / 4];
/// What the feeder sends.
static SENT: AtomicU8 = AtomicU8::new(MASTER_BYTE);

/// The sensor's frames. Pins: SCK PA5, MISO PA6, MOSI PA7, /SS PB6; PA7 and
/// PA6 are joined outside: one open-drain line.
pub(crate) struct Frames {
    select: Pin<B, 6>,
    running: bool,
}

impl Frames {
    /// Sets everything up; the first frame starts with the first
    /// [`take`](FrameSource::take). The sensor must have had its start-up time
    /// by then.
    pub(crate) fn new(slot_counts: u16) -> Self {
        let select = Pin::new_high();
        clock_sensor();
        PACER
            .arr()
            .write(|w| w.set_arr(slot_counts.saturating_sub(1)));
        // Pointers have 32 bits on these chips.
        let (received, sent) = (RECEIVED.as_ptr() as u32, SENT.as_ptr() as u32);
        mover::set_up(spi::data_register(), received, sent);
        set_up_spi();

        // Only now, so that the clock line never carries anything but the clock.
        // A fast edge: a slow one delays the clock that the SPI itself sees and
        // may cost it the last bit (errata sheet of the STM32F4).
        Pin::<A, 5>::new(Mode::DrivesFast(SPI_PINS));
        Pin::<A, 6>::new(Mode::Hears(SPI_PINS));
        Pin::<A, 7>::new(Mode::DrivesOpenDrain(SPI_PINS));
        Self {
            select,
            running: false,
        }
    }

    #[inline]
    fn start(&mut self) {
        // A byte left over would come before the first of this frame.
        spi::drain();
        compiler_fence(Ordering::Release);
        mover::start(FRAME_LEN as u16);
        self.select.low();
        PACER.cnt().write(|_| {});
        PACER.sr().write(|_| {});
        PACER.dier().write(|w| w.set_ude(true));
        PACER.cr1().write(|w| w.set_cen(true));
        self.running = true;
    }

    /// Stops the pacer and raises /SS. Its request is withdrawn too: one that
    /// is still pending would put a byte before the next frame.
    #[inline]
    fn stop(&mut self) {
        PACER.cr1().write(|_| {});
        PACER.dier().write(|_| {});
        self.select.high();
    }

    /// The collector's interrupt: the frame is complete, or broken.
    #[inline]
    pub(crate) fn end_of_frame(&mut self) {
        if !mover::has_ended() {
            // It was served late, after `take` had begun another frame.
            return;
        }
        self.stop();
        // The flags stay for `take`; only the interrupt has been served.
        mover::acknowledge();
    }

    /// Ends a frame that went wrong and makes ready for another one.
    #[cold]
    fn abort(&mut self) {
        self.stop();
        mover::stop();
        set_up_spi();
    }
}

/// Also the way to forget a frame that broke off in the middle of a byte.
fn set_up_spi() {
    reset_spi();
    spi::set_up();
}

/// Whether all eight bytes were moved and none was lost.
#[inline]
fn is_complete() -> bool {
    let wire = SPI1.sr().read();
    mover::is_complete() && !wire.ovr() && !wire.modf()
}

impl FrameSource for Frames {
    /// Hands over the frame that the last call started, and starts the next.
    ///
    /// After an error no frame is started: /SS is high for a tick, so that the
    /// sensor begins anew, and the next call finds none.
    #[inline]
    fn take(&mut self) -> Result<Option<[u8; FRAME_LEN]>, BusError> {
        let mut taken = None;
        if self.running {
            self.running = false;
            if !is_complete() {
                self.abort();
                return Err(BusError);
            }
            // After an interrupt that came too late for `end_of_frame`.
            self.stop();
            compiler_fence(Ordering::Acquire);
            let words = RECEIVED.each_ref().map(|word| word.load(Ordering::Relaxed));
            let [[a, b, c, d], [e, f, g, h]] = words.map(u32::to_ne_bytes);
            taken = Some([a, b, c, d, e, f, g, h]);
        }
        self.start();
        Ok(taken)
    }
}
