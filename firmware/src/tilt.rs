//! A TMAG5170 below a magnet, as a source of words: from three fields to two tilts.
//!
//! A magnet that turns with the whisker's base tilts its field. On its axis a dipole has
//! B cos φ along Z and −B/2 · sin φ across, so −2 X/Z is tan φ whatever the magnet's strength,
//! its distance and its temperature. A word is tan φ in units of the full scale; up to 0.15 rad
//! tan φ is within 0.8 % of φ.

use embedded_hal::spi::SpiDevice;
use mlx90333::{Decoder, Word};
use tmag5170::{Config, DataType, Error, Field, ReplyError, StatusFaults, Tmag5170, Version};

use crate::io::WordSource;
use crate::{SensorFault, TiltFault};

/// Least code along Z, 1/64 of its full scale: 1.6 of 100 mT. Below it there is no magnet, or
/// it is upside down.
const LEAST_Z: i32 = 512;

/// Codes of a word from mid-scale to full scale.
const FULL_CODES: i32 = 8191;

/// From fields to words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TiltScale {
    /// Codes of a word for X/Z and for Y/Z of 1, both in codes of fields.
    slopes: [i32; 2],
}

impl TiltScale {
    /// Words whose full scale is this tilt (as its tangent), for the ranges of `config`.
    ///
    /// `None` if a field of X or Y would have more than 65,535 codes of a word for each of Z:
    /// with equal ranges, for full scales below 0.25; with X and Y a quarter of Z, below
    /// 0.0625.
    pub fn new(config: &Config, full_scale: f32) -> Option<Self> {
        // Both parts have the same ratios of ranges.
        let ranges = config.sensor.ranges;
        let [x, y, z] = ranges.map(|range| range.full_scale_mt(Version::A1));
        let slope = |range_mt: f32| {
            let slope = 2.0 * FULL_CODES as f32 * range_mt / (z * full_scale);
            // A product with a code stays within 31 bits.
            (1.0..65_535.0).contains(&slope).then_some(slope as i32)
        };
        Some(Self {
            slopes: [slope(x)?, slope(y)?],
        })
    }

    /// The words of X, Y and Z, limited to full scale.
    ///
    /// # Errors
    /// [`TiltFault::NoMagnet`].
    #[inline]
    pub fn words(self, [x, y, z]: [Field; 3]) -> Result<[Word; 2], TiltFault> {
        let z = i32::from(z.code());
        if z < LEAST_Z {
            return Err(TiltFault::NoMagnet);
        }
        let [x_slope, y_slope] = self.slopes;
        let word = |field: Field, slope: i32| {
            let codes = -i32::from(field.code()) * slope / z;
            let code = codes.clamp(-FULL_CODES, FULL_CODES) + FULL_CODES + 1;
            Word::new((code as u16) << 2)
        };
        Ok([word(x, x_slope), word(y, y_slope)])
    }
}

/// A TMAG5170 behind an ordinary blocking [`SpiDevice`], read in the tick itself, each axis by a
/// frame of its own: a set of conversions may end between two of them.
///
/// It is configured by the first read, and again whenever it has restarted; no words come of
/// such a tick. Until its first conversion has ended, 0.5 ms later, it reads as
/// [`TiltFault::NoMagnet`], which is bridged like any bad frame.
#[derive(Debug)]
pub struct TiltSource<SPI> {
    sensor: Tmag5170<SPI>,
    config: Config,
    scale: TiltScale,
    is_configured: bool,
}

impl<SPI: SpiDevice> TiltSource<SPI> {
    /// Takes a sensor, which is set up as `config` has it, but for its replies, which carry
    /// registers.
    pub fn new(sensor: Tmag5170<SPI>, config: Config, scale: TiltScale) -> Self {
        let mut config = config;
        config.system.data_type = DataType::Register;
        Self {
            sensor,
            config,
            scale,
            is_configured: false,
        }
    }

    /// The sensor, for a simulation that looks at its bus.
    pub const fn sensor_mut(&mut self) -> &mut Tmag5170<SPI> {
        &mut self.sensor
    }

    /// What the sensor reports, which that clears, if it lets it be read.
    fn report(&mut self) -> TiltFault {
        match self.sensor.faults() {
            Ok(faults) => TiltFault::Reported(faults),
            Err(Error::Frame(error)) => TiltFault::Reply(error),
            Err(_) => TiltFault::Reported(StatusFaults::NONE),
        }
    }
}

impl<SPI: SpiDevice> WordSource for TiltSource<SPI> {
    /// The decoder is the other sensor's.
    fn words(&mut self, _: Decoder) -> Result<[Word; 2], SensorFault> {
        if !self.is_configured {
            self.sensor
                .configure(self.config)
                .map_err(|error| fault(&error))?;
            self.is_configured = true;
            return Err(SensorFault::NoFrame);
        }
        match self.sensor.fields() {
            Ok(fields) => self.scale.words(fields).map_err(SensorFault::Tilt),
            Err(Error::Frame(ReplyError::Sensor(_))) => Err(SensorFault::Tilt(self.report())),
            Err(error) => {
                self.is_configured &= !matches!(error, Error::Frame(ReplyError::Restarted));
                Err(fault(&error))
            }
        }
    }
}

fn fault<E>(error: &Error<E>) -> SensorFault {
    match *error {
        Error::Bus(_) => SensorFault::Bus,
        Error::Frame(error) => SensorFault::Tilt(TiltFault::Reply(error)),
        Error::NotWritten(register) => SensorFault::Tilt(TiltFault::NotWritten(register)),
    }
}
