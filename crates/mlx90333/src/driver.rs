//! Blocking reads over an embedded-hal `SpiDevice`.

use core::{array, fmt, slice};

use embedded_hal::spi::{Operation, SpiDevice};

use crate::{Decoder, FRAME_LEN, Frame, FrameError, MASTER_BYTE};

/// Why a read gave no frame. `E` is the bus's own error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error<E> {
    /// The SPI peripheral or its chip select failed.
    Bus(E),
    /// Eight bytes came, but not a valid frame.
    Frame(FrameError),
}

impl<E> From<FrameError> for Error<E> {
    fn from(error: FrameError) -> Error<E> {
        Error::Frame(error)
    }
}

// Bus errors are `Debug` by embedded-hal's contract and seldom more.
impl<E: fmt::Debug> fmt::Display for Error<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Bus(error) => write!(f, "SPI bus: {error:?}"),
            Error::Frame(error) => error.fmt(f),
        }
    }
}

impl<E: fmt::Debug> core::error::Error for Error<E> {}

/// A sensor on an SPI bus set to [`SPI_MODE`](crate::SPI_MODE), clocked at no
/// more than [`CLOCK_MAX_HZ`](crate::timing::CLOCK_MAX_HZ).
///
/// Before the first read wait
/// [`START_UP_WAIT_US`](crate::timing::START_UP_WAIT_US) after power-up.
#[derive(Debug)]
pub struct Mlx90333<SPI> {
    spi: SPI,
    decoder: Decoder,
}

impl<SPI> Mlx90333<SPI> {
    /// Takes the bus; sends nothing.
    pub const fn new(spi: SPI, decoder: Decoder) -> Mlx90333<SPI> {
        Mlx90333 { spi, decoder }
    }

    /// How frames are decoded.
    pub const fn decoder(&self) -> Decoder {
        self.decoder
    }

    /// The bus, for a simulation that has the sensor behind it.
    pub const fn spi_mut(&mut self) -> &mut SPI {
        &mut self.spi
    }

    /// Gives the bus back.
    pub fn release(self) -> SPI {
        self.spi
    }
}

impl<SPI: SpiDevice> Mlx90333<SPI> {
    /// Reads the eight bytes of a frame back to back, without decoding them.
    ///
    /// # Errors
    /// [`Error::Bus`] only.
    pub fn read_raw(&mut self) -> Result<[u8; FRAME_LEN], Error<SPI::Error>> {
        let mut bytes = [MASTER_BYTE; FRAME_LEN];
        self.spi.transfer_in_place(&mut bytes).map_err(Error::Bus)?;
        Ok(bytes)
    }

    /// As [`read_raw`](Mlx90333::read_raw), with `gap_ns` nanoseconds between
    /// bytes while /SS stays low.
    ///
    /// # Errors
    /// [`Error::Bus`] only; a bus that cannot wait inside a transaction says so
    /// here.
    pub fn read_raw_paced(&mut self, gap_ns: u32) -> Result<[u8; FRAME_LEN], Error<SPI::Error>> {
        let mut bytes = [MASTER_BYTE; FRAME_LEN];
        let mut places = bytes.iter_mut();
        // A byte, then a gap and a byte seven times.
        let mut operations: [_; 2 * FRAME_LEN - 1] = array::from_fn(|n| {
            let place = if n % 2 == 0 { places.next() } else { None };
            place.map_or(Operation::DelayNs(gap_ns), |byte| {
                Operation::TransferInPlace(slice::from_mut(byte))
            })
        });
        self.spi.transaction(&mut operations).map_err(Error::Bus)?;
        Ok(bytes)
    }

    /// Reads and decodes a frame, bytes back to back: for a clock slow enough
    /// that the sensor keeps up.
    ///
    /// # Errors
    /// [`Error::Bus`] if the bus failed, [`Error::Frame`] if what came is not a
    /// valid frame.
    pub fn read(&mut self) -> Result<Frame, Error<SPI::Error>> {
        let bytes = self.read_raw()?;
        Ok(self.decoder.decode(&bytes)?)
    }

    /// As [`read`](Mlx90333::read), with `gap_ns` nanoseconds between bytes;
    /// [`BYTE_GAP_SAFE_NS`](crate::timing::BYTE_GAP_SAFE_NS) is safe.
    ///
    /// # Errors
    /// As for [`read`](Mlx90333::read).
    pub fn read_paced(&mut self, gap_ns: u32) -> Result<Frame, Error<SPI::Error>> {
        let bytes = self.read_raw_paced(gap_ns)?;
        Ok(self.decoder.decode(&bytes)?)
    }
}
