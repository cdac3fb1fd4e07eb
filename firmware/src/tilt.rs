//! A TMAG5170 below a magnet, as a source of words: from three fields to two tilts.
//!
//! A magnet that turns with the whisker's base tilts its field. On its axis a dipole has
//! B cos φ along Z and −B/2 · sin φ across, so −2 X/Z is tan φ whatever the magnet's strength,
//! its distance and its temperature. A word is tan φ in units of the full scale; up to 0.15 rad
//! tan φ is within 0.8 % of φ.

use embedded_hal::spi::SpiDevice;
use mlx90333::{Decoder, Word};
use tmag5170::{
    Average, Channels, Config, DeviceConfig, Error, Field, OperatingMode, Range, ReplyError,
    SensorConfig, StatusFaults, Tmag5170, Version,
};

use crate::io::WordSource;
use crate::{SensorFault, TiltFault};

/// Least code along Z, 1.6 of 100 mT: below it there is no magnet, or it is upside down.
const LEAST_Z: i32 = 512;

/// The largest code of a field, of one conversion: there the field may be any that is larger.
const END: u16 = 0x7FF0;

/// Codes of a word from mid-scale to full scale.
const FULL_CODES: i32 = 8191;

/// Full scale of a module's words, as the tangent of the tilt.
pub const FULL_SCALE: f32 = 0.15;

/// Ranges of a module's X, Y and Z: docs/build.md has the fields.
const RANGES: [Range; 3] = [Range::Narrow, Range::Narrow, Range::Wide];

/// From fields to words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TiltScale {
    /// Codes of a word for X/Z and for Y/Z of 1, both in codes of fields.
    slopes: [i32; 2],
}

impl TiltScale {
    /// Words whose full scale is this tilt (as its tangent), for the ranges of `config`.
    ///
    /// `None` if a field of X or Y would have more than 65,535 codes of a word for each of Z: with
    /// equal ranges, for full scales below 0.25; with X and Y a quarter of Z, below 0.0625.
    pub const fn new(config: &Config, full_scale: f32) -> Option<Self> {
        Self::of_ranges(config.sensor.ranges, full_scale)
    }

    const fn of_ranges([x, y, z]: [Range; 3], full_scale: f32) -> Option<Self> {
        match (slope(x, z, full_scale), slope(y, z, full_scale)) {
            (Some(x), Some(y)) => Some(Self { slopes: [x, y] }),
            _ => None,
        }
    }

    /// The words of X, Y and Z, limited to full scale. Where one of the three is at the end of its
    /// range no tilt is known: then both words are at the end of theirs.
    ///
    /// # Errors
    /// [`TiltFault::NoMagnet`].
    #[inline]
    pub fn words(self, fields: [Field; 3]) -> Result<[Word; 2], TiltFault> {
        let [x, y, z] = fields.map(Field::code);
        if i32::from(z) < LEAST_Z {
            return Err(TiltFault::NoMagnet);
        }
        // Below the 14 bits of a word stand some of the fields' noise, so that words at the end of
        // their range are not taken for a sensor that stands still.
        let noise = ((x ^ y ^ z) as u16 >> 4) & 3;
        let word = |code: i32| Word::new((code as u16) << 2 | noise);
        if [x, y, z].iter().any(|code| code.unsigned_abs() >= END) {
            return Ok([word(2 * FULL_CODES + 1); 2]);
        }
        let [x_slope, y_slope] = self.slopes;
        let tilt = |field: i16, slope: i32| {
            let product = -i32::from(field) * slope;
            // Z is not zero, which the compiler does not see here.
            let codes = product.checked_div(i32::from(z)).unwrap_or(0);
            word(codes.clamp(-FULL_CODES, FULL_CODES) + FULL_CODES + 1)
        };
        Ok([tilt(x, x_slope), tilt(y, y_slope)])
    }
}

/// Codes of a word where fields of both ranges have the same code; `None`: too many for a product.
const fn slope(across: Range, axial: Range, full_scale: f32) -> Option<i32> {
    // Both parts have the same ratios of ranges.
    let across_mt = across.full_scale_mt(Version::A1);
    let axial_mt = axial.full_scale_mt(Version::A1);
    let slope = 2.0 * FULL_CODES as f32 * across_mt / (axial_mt * full_scale);
    // A product with a code stays within 31 bits.
    if slope >= 1.0 && slope < 65_535.0 {
        Some(slope as i32)
    } else {
        None
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
    /// Set up as `config` has it.
    pub const fn new(sensor: Tmag5170<SPI>, config: Config, scale: TiltScale) -> Self {
        Self {
            sensor,
            config,
            scale,
            is_configured: false,
        }
    }

    /// The sensor of a module behind `spi`: all axes, four conversions an average, which are the
    /// most that are new in every tick of 2 kHz, and tilts in units of [`FULL_SCALE`].
    pub fn of_module(spi: SPI) -> Self {
        const SCALE: TiltScale = match TiltScale::of_ranges(RANGES, FULL_SCALE) {
            Some(scale) => scale,
            None => panic!("the ranges do not fit the full scale"),
        };
        let config = Config {
            device: DeviceConfig {
                average: Average::X4,
                mode: OperatingMode::Active,
                ..DeviceConfig::default()
            },
            sensor: SensorConfig {
                channels: Channels::Xyz,
                ranges: RANGES,
                ..SensorConfig::default()
            },
            ..Config::default()
        };
        Self::new(Tmag5170::new(spi), config, SCALE)
    }

    /// The sensor, for a simulation that looks at its bus.
    pub const fn sensor_mut(&mut self) -> &mut Tmag5170<SPI> {
        &mut self.sensor
    }

    /// What the sensor reports, which that clears, if it lets it be read.
    fn report(&mut self) -> TiltFault {
        match self.sensor.faults() {
            Ok(faults) => {
                // That is said once: it would not be configured again.
                self.is_configured &= !faults.contains(StatusFaults::RESTARTED);
                TiltFault::Reported(faults)
            }
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
