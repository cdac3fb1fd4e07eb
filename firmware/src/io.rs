//! What the module asks of the hardware, and an adaptor for a blocking bus.

use embedded_hal::spi::SpiDevice;
use mlx90333::{Decoder, FRAME_LEN, Frame, FrameError, Mlx90333, Word};

use crate::SensorFault;

/// The bus did not deliver: no transfer ran, or the controller reported an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BusError;

/// Where finished sensor frames come from.
///
/// Reading takes most of a tick (64 bits at 400 kHz are 160 µs), so a board reads by DMA meanwhile.
///
/// The sensor is deselected for some time between two good frames; after a bad one
/// [`start`](Self::start) comes some ticks later, so that the sensor resynchronises.
pub trait FrameSource {
    /// The frame that was started last, if it is finished. Afterwards there is none under way.
    ///
    /// # Errors
    /// [`BusError`] if the transfer failed.
    fn take(&mut self) -> Result<Option<[u8; FRAME_LEN]>, BusError>;

    /// Starts a frame. Nothing to do where [`take`](Self::take) itself reads one.
    #[inline]
    fn start(&mut self) {}

    /// The last frame as it came, good or not, where that is kept.
    fn last(&self) -> Option<[u8; FRAME_LEN]> {
        None
    }
}

/// Where a whisker's words come from, whatever its sensor. Every [`FrameSource`] is one.
pub trait WordSource {
    /// The words of what was read last, without waiting: of frames by the `decoder`.
    ///
    /// # Errors
    /// Why there are none.
    fn words(&mut self, decoder: Decoder) -> Result<[Word; 2], SensorFault>;

    /// Starts to read the next. Nothing to do where [`words`](Self::words) itself reads.
    #[inline]
    fn begin(&mut self) {}

    /// The last frame as it came, where words come by frames.
    fn last(&self) -> Option<[u8; FRAME_LEN]> {
        None
    }
}

/// A frame by any decoder, where time does not matter.
#[cold]
#[inline(never)]
pub(crate) fn decode_otherwise(
    decoder: Decoder,
    bytes: [u8; FRAME_LEN],
) -> Result<Frame, FrameError> {
    decoder.decode(&bytes)
}

impl<F: FrameSource> WordSource for F {
    #[inline]
    fn words(&mut self, decoder: Decoder) -> Result<[Word; 2], SensorFault> {
        let taken = self.take().map_err(|_| SensorFault::Bus)?;
        let bytes = taken.ok_or(SensorFault::NoFrame)?;
        // The usual one is known as this is compiled, which halves what it costs.
        let frame = if decoder == const { Decoder::new() } {
            const { Decoder::new() }.decode_here(&bytes)
        } else {
            decode_otherwise(decoder, bytes)
        };
        let frame = frame.map_err(SensorFault::Frame)?;
        Ok([frame.first, frame.second])
    }

    #[inline]
    fn begin(&mut self) {
        self.start();
    }

    fn last(&self) -> Option<[u8; FRAME_LEN]> {
        FrameSource::last(self)
    }
}

/// Where the whisker is.
pub trait AngleInput {
    /// Counts of encoder or Hall sectors, which rise with protraction. They may wrap around.
    fn counts(&mut self) -> i32;
}

/// A free-running counter, to measure how long ticks take.
pub trait Clock {
    /// Counts now; wraps around.
    fn now(&mut self) -> u32;
}

/// A sensor behind a blocking [`SpiDevice`], read in the tick itself: for slow ticks and for tests.
#[derive(Debug)]
pub struct Polled<SPI> {
    sensor: Mlx90333<SPI>,
    last: [u8; FRAME_LEN],
}

impl<SPI: SpiDevice> Polled<SPI> {
    /// Takes the sensor.
    pub const fn new(sensor: Mlx90333<SPI>) -> Self {
        Self {
            sensor,
            last: [0; FRAME_LEN],
        }
    }

    /// The sensor, for a simulation that looks at its bus.
    pub const fn sensor_mut(&mut self) -> &mut Mlx90333<SPI> {
        &mut self.sensor
    }
}

impl<SPI: SpiDevice> FrameSource for Polled<SPI> {
    fn take(&mut self) -> Result<Option<[u8; FRAME_LEN]>, BusError> {
        self.last = self.sensor.read_raw().map_err(|_| BusError)?;
        Ok(Some(self.last))
    }

    fn last(&self) -> Option<[u8; FRAME_LEN]> {
        Some(self.last)
    }
}
