//! The sensor's frames, read without the core: SPI1, paced by a timer, moved
//! by DMA.
//!
//! - *slot*: the time from the start of a byte to that of the next. The sensor
//!   needs a gap between bytes, which no SPI controller makes by itself.
//! - *pacer*: TIM8. Each of its updates lets DMA2 stream 1 write one 0xFF into
//!   the SPI's data register; the first comes one slot after /SS went low.
//! - *collector*: DMA2 stream 0, which moves each received byte to memory and
//!   interrupts after the eighth.
//!
//! A frame is a matter of some ten register writes: [`Frames::take`] in a tick
//! starts one, [`Frames::end_of_frame`] in the collector's interrupt raises
//! /SS, and the next [`Frames::take`] hands the bytes over. The hardware's own
//! flags are the only state they share.
//!
//! Requests (RM0390, DMA2 request mapping): stream 0 channel 3 is SPI1_RX,
//! stream 1 channel 7 is TIM8_UP.

use core::sync::atomic::{AtomicU8, Ordering, compiler_fence};

use firmware::{BusError, FrameSource};
use mlx90333::{FRAME_LEN, MASTER_BYTE};
use stm32f4xx_hal::gpio::{Output, PA5, PA6, PA7, PB6, PinState, Speed};
use stm32f4xx_hal::pac::{DMA2, RCC, SPI1, TIM8};
use stm32f4xx_hal::rcc::{Enable, Reset};

const COLLECTOR: usize = 0;
const FEEDER: usize = 1;

/// Where the collector puts the bytes. Atomic because the DMA writes them
/// behind the compiler's back.
static RECEIVED: [AtomicU8; FRAME_LEN] = [const { AtomicU8::new(0) }; FRAME_LEN];
/// What the feeder sends.
static SENT: AtomicU8 = AtomicU8::new(MASTER_BYTE);

/// The pins of the sensor. PA7 and PA6 are joined outside: one open-drain line.
pub(crate) struct Pins {
    pub(crate) sck: PA5,
    pub(crate) miso: PA6,
    pub(crate) mosi: PA7,
    pub(crate) select: PB6,
}

/// The sensor's frames.
pub struct Frames {
    spi: SPI1,
    pacer: TIM8,
    dma: DMA2,
    select: PB6<Output>,
    running: bool,
}

impl Frames {
    /// Sets everything up; the first frame starts with the first
    /// [`take`](FrameSource::take). The sensor must have had its start-up time
    /// by then.
    pub(crate) fn new(
        spi: SPI1,
        pacer: TIM8,
        dma: DMA2,
        pins: Pins,
        slot_counts: u16,
        rcc: &mut RCC,
    ) -> Self {
        let select = pins.select.into_push_pull_output_in_state(PinState::High);
        DMA2::enable(rcc);
        DMA2::reset(rcc);
        TIM8::enable(rcc);
        TIM8::reset(rcc);
        SPI1::enable(rcc);
        let mut frames = Self {
            spi,
            pacer,
            dma,
            select,
            running: false,
        };
        frames.set_up_pacer(slot_counts);
        frames.set_up_streams();
        frames.set_up_spi();

        // Only now, so that the clock line never carries anything but the clock.
        // A fast edge: a slow one delays the clock that the SPI itself sees and
        // may cost it the last bit (errata sheet).
        pins.sck.into_alternate::<5>().speed(Speed::High);
        pins.miso.into_alternate::<5>();
        pins.mosi.into_alternate_open_drain::<5>();
        frames
    }

    fn set_up_pacer(&mut self, slot_counts: u16) {
        self.pacer
            .arr()
            .write(|w| w.arr().set(slot_counts.saturating_sub(1)));
    }

    fn set_up_streams(&mut self) {
        // Pointers have 32 bits on this chip.
        let data_register = self.spi.dr().as_ptr() as u32;
        let (received, sent) = (RECEIVED.as_ptr() as u32, SENT.as_ptr() as u32);
        let (collector, feeder) = (self.dma.st(COLLECTOR), self.dma.st(FEEDER));
        #[allow(unsafe_code, reason = "a DMA address is a raw pointer")]
        // SAFETY: the streams move eight bytes at most (NDTR): the collector to a static
        // of that length that only atomics touch, the feeder from one byte that it does
        // not leave; the other side is the data register of an SPI that is ours.
        unsafe {
            collector.par().write(|w| w.bits(data_register));
            collector.m0ar().write(|w| w.bits(received));
            feeder.par().write(|w| w.bits(data_register));
            feeder.m0ar().write(|w| w.bits(sent));
        }
    }

    /// Mode 1, most significant bit first, bytes, the slowest clock; /SS is
    /// ours. Also the way to forget a frame that broke off in the middle of a
    /// byte.
    fn set_up_spi(&mut self) {
        #[allow(unsafe_code, reason = "the RCC's owner is not at hand in a tick")]
        // SAFETY: pulses one bit of a register that is otherwise written at start only.
        unsafe {
            SPI1::reset_unchecked();
        }
        self.spi.cr2().write(|w| w.rxdmaen().set_bit());
        self.spi.cr1().write(|w| {
            w.mstr().set_bit().ssm().set_bit().ssi().set_bit();
            w.cpol().clear_bit().cpha().set_bit();
            w.lsbfirst().clear_bit().dff().clear_bit();
            w.br().div256();
            w.spe().set_bit()
        });
    }

    #[inline]
    fn start(&mut self) {
        // A byte left over would come before the first of this frame.
        let _ = self.spi.dr().read();
        self.dma.lifcr().write(|w| {
            w.ctcif0().set_bit().cteif0().set_bit().cdmeif0().set_bit();
            w.chtif0().set_bit().cfeif0().set_bit();
            w.ctcif1().set_bit().cteif1().set_bit().cdmeif1().set_bit();
            w.chtif1().set_bit().cfeif1().set_bit()
        });
        let collector = self.dma.st(COLLECTOR);
        collector.ndtr().write(|w| w.ndt().set(FRAME_LEN as u16));
        compiler_fence(Ordering::Release);
        collector.cr().write(|w| {
            w.chsel().set(3).dir().peripheral_to_memory();
            w.minc().set_bit().pl().very_high();
            w.tcie().set_bit().teie().set_bit();
            w.en().set_bit()
        });
        let feeder = self.dma.st(FEEDER);
        feeder.ndtr().write(|w| w.ndt().set(FRAME_LEN as u16));
        feeder.cr().write(|w| {
            w.chsel().set(7).dir().memory_to_peripheral();
            w.en().set_bit()
        });

        self.select.set_low();
        self.pacer.cnt().reset();
        self.pacer.sr().reset();
        self.pacer.dier().write(|w| w.ude().set_bit());
        self.pacer.cr1().write(|w| w.cen().set_bit());
        self.running = true;
    }

    /// Stops the pacer and raises /SS. Its request is withdrawn too: one that
    /// is still pending would put a byte before the next frame.
    #[inline]
    fn stop(&mut self) {
        self.pacer.cr1().reset();
        self.pacer.dier().reset();
        self.select.set_high();
    }

    /// The collector's interrupt: the frame is complete, or broken.
    #[inline]
    pub(crate) fn end_of_frame(&mut self) {
        let moved = self.dma.lisr().read();
        if moved.tcif0().bit_is_clear() && moved.teif0().bit_is_clear() {
            // It was served late, after `take` had begun another frame.
            return;
        }
        self.stop();
        // The flags stay for `take`; only the interrupt has been served.
        self.dma
            .st(COLLECTOR)
            .cr()
            .modify(|_, w| w.tcie().clear_bit().teie().clear_bit());
    }

    /// Whether all eight bytes were moved and none was lost.
    #[inline]
    fn is_complete(&self) -> bool {
        let moved = self.dma.lisr().read();
        let spi = self.spi.sr().read();
        moved.tcif0().bit_is_set()
            && moved.teif0().bit_is_clear()
            && moved.dmeif0().bit_is_clear()
            && moved.teif1().bit_is_clear()
            && moved.dmeif1().bit_is_clear()
            && spi.ovr().bit_is_clear()
            && spi.modf().bit_is_clear()
    }

    /// Ends a frame that went wrong and makes ready for another one.
    #[cold]
    fn abort(&mut self) {
        self.stop();
        for stream in [COLLECTOR, FEEDER] {
            let stream = self.dma.st(stream);
            stream.cr().reset();
            // A stream stops after the byte in hand, some bus cycles. One that
            // does not is found out by the next frame.
            let _ = (0..1_000).any(|_| stream.cr().read().en().bit_is_clear());
        }
        self.set_up_spi();
    }
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
            if !self.is_complete() {
                self.abort();
                return Err(BusError);
            }
            // After an interrupt that came too late for `end_of_frame`.
            self.stop();
            compiler_fence(Ordering::Acquire);
            taken = Some(RECEIVED.each_ref().map(|byte| byte.load(Ordering::Relaxed)));
        }
        self.start();
        Ok(taken)
    }
}
