//! Reads and writes over an embedded-hal `SpiDevice`, one frame a transaction.

use core::fmt;

use embedded_hal::spi::SpiDevice;

use crate::{
    Command, Config, FRAME_LEN, Field, OperatingMode, Register, Reply, ReplyError, StatusFaults,
    SystemConfig, check,
};

/// Why there is no reading. `E` is the bus's own error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error<E> {
    /// The SPI peripheral or its chip select failed.
    Bus(E),
    /// Four bytes came, but not a reading.
    Frame(ReplyError),
    /// A setting was sent and does not read back. Likely cause: noise on SDI, or the sensor
    /// restarted meanwhile.
    NotWritten(Register),
}

impl<E> From<ReplyError> for Error<E> {
    fn from(error: ReplyError) -> Error<E> {
        Error::Frame(error)
    }
}

// Bus errors are `Debug` by embedded-hal's contract and seldom more.
impl<E: fmt::Debug> fmt::Display for Error<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Bus(error) => write!(f, "SPI bus: {error:?}"),
            Error::Frame(error) => error.fmt(f),
            Error::NotWritten(register) => write!(f, "{register:?} does not read back"),
        }
    }
}

impl<E: fmt::Debug> core::error::Error for Error<E> {}

/// A sensor on an SPI bus set to [`SPI_MODE`](crate::SPI_MODE), clocked at no more than
/// [`CLOCK_MAX_HZ`](crate::timing::CLOCK_MAX_HZ).
///
/// Before the first frame wait
/// [`START_UP_WAIT_US`](crate::timing::START_UP_WAIT_US) after power-up.
#[derive(Debug)]
pub struct Tmag5170<SPI> {
    spi: SPI,
}

impl<SPI> Tmag5170<SPI> {
    /// Takes the bus; sends nothing.
    pub const fn new(spi: SPI) -> Tmag5170<SPI> {
        Tmag5170 { spi }
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

impl<SPI: SpiDevice> Tmag5170<SPI> {
    /// Sends a command and returns the four bytes that came meanwhile, without decoding them.
    ///
    /// # Errors
    /// [`Error::Bus`] only.
    pub fn exchange(&mut self, command: Command) -> Result<[u8; FRAME_LEN], Error<SPI::Error>> {
        let mut bytes = command.bytes();
        self.spi.transfer_in_place(&mut bytes).map_err(Error::Bus)?;
        Ok(bytes)
    }

    /// Reads a register, whatever the status says.
    ///
    /// # Errors
    /// [`Error::Bus`], or [`Error::Frame`] if the reply did not arrive whole.
    pub fn read(&mut self, register: Register) -> Result<Reply, Error<SPI::Error>> {
        let bytes = self.exchange(Command::read(register))?;
        Ok(Reply::decode(&bytes)?)
    }

    /// Writes a register. Four check bits let one garbled reply in 16 pass: what matters is
    /// to be read back, as [`configure`](Tmag5170::configure) does.
    ///
    /// # Errors
    /// [`Error::Bus`], or [`Error::Frame`] if the reply did not arrive whole;
    /// [`ReplyError::Rejected`] if the sensor has not written it.
    pub fn write(&mut self, register: Register, value: u16) -> Result<(), Error<SPI::Error>> {
        let bytes = self.exchange(Command::write(register, value))?;
        Ok(check(&bytes)?)
    }

    /// Writes all settings, and reads each back. Leaves the sensor as `config` has it: in its
    /// operating mode. Returns what the sensor reported before; after power-up that is
    /// [`StatusFaults::RESTARTED`].
    ///
    /// Wait [`START_MEASURING_US`](crate::timing::START_MEASURING_US) and a set of
    /// conversions before the first reading.
    ///
    /// # Errors
    /// [`Error::Bus`], [`Error::Frame`], or [`Error::NotWritten`] with the first setting that
    /// is not what it should be. The sensor is then in configuration mode or as it was.
    pub fn configure(&mut self, config: Config) -> Result<StatusFaults, Error<SPI::Error>> {
        // Its replies may carry no registers, if another master has configured it.
        self.write(Register::SystemConfig, SystemConfig::default().bits())?;
        let before = self.faults()?;
        let mut idle = config.device;
        idle.mode = OperatingMode::Configuration;
        let as_after_reset = |register: Register| (register, register.after_reset());
        let settings = [
            (Register::DeviceConfig, idle.bits()),
            (Register::SensorConfig, config.sensor.bits()),
            as_after_reset(Register::AlertConfig),
            as_after_reset(Register::XThresholds),
            as_after_reset(Register::YThresholds),
            as_after_reset(Register::ZThresholds),
            // What makes it measure.
            (Register::DeviceConfig, config.device.bits()),
            (Register::SystemConfig, config.system.bits()),
        ];
        for (register, value) in settings {
            self.set(register, value)?;
        }
        Ok(before)
    }

    fn set(&mut self, register: Register, value: u16) -> Result<(), Error<SPI::Error>> {
        self.write(register, value)?;
        if self.read(register)?.value == value {
            Ok(())
        } else {
            Err(Error::NotWritten(register))
        }
    }

    /// The fields along X, Y and Z, in three frames. An axis that is not measured reads as 0.
    ///
    /// # Errors
    /// [`Error::Bus`], or [`Error::Frame`]: also [`ReplyError::Restarted`] and
    /// [`ReplyError::Sensor`].
    pub fn fields(&mut self) -> Result<[Field; 3], Error<SPI::Error>> {
        let mut axis = |register| -> Result<Field, Error<SPI::Error>> {
            Ok(Field::new(self.read(register)?.trusted()?))
        };
        Ok([axis(Register::X)?, axis(Register::Y)?, axis(Register::Z)?])
    }

    /// What the sensor reports about itself; [`StatusFaults::RESTARTED`] is cleared by that.
    ///
    /// # Errors
    /// [`Error::Bus`], or [`Error::Frame`] if a reply did not arrive whole.
    pub fn faults(&mut self) -> Result<StatusFaults, Error<SPI::Error>> {
        let afe_status = self.read(Register::AfeStatus)?.value;
        let sys_status = self.read(Register::SysStatus)?.value;
        Ok(StatusFaults::new(afe_status, sys_status))
    }
}
