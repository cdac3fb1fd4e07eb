//! A configuration as bytes.
//!
//! A [`Header`] of [`HEADER_BYTES`] bytes (magic, version, board, number format, length, CRC-32),
//! then the parts in their order, each by postcard. The sum covers everything behind it. Integers
//! of the header are little-endian.

use heapless::string::StringView;
use serde::{Deserialize, Serialize};
use whisking::{Real, Start};
use wire::{Reader, crc32};

use super::{Config, ConfigError, MotionConfig, Part};
use crate::servo::ServoConfig;

/// The version of the layout.
pub const VERSION: u16 = 8;

/// Most bytes of a configuration with its header, of two whiskers; a simulation's may be longer.
pub const CONFIG_BYTES: usize = if cfg!(target_os = "none") { 1536 } else { 4096 };

/// Bytes of a [`Header`].
pub const HEADER_BYTES: usize = 16;

const MAGIC: u32 = u32::from_le_bytes(*b"WCFG");

/// A word of flash that nothing was written to.
pub(crate) const ERASED: u32 = u32::MAX;

/// Which program a configuration is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum BoardCode {
    /// A simulation on a PC.
    Simulation = 0,
    /// NUCLEO-F446RE.
    NucleoF446re = 1,
    /// NUCLEO-F103RB.
    NucleoF103rb = 2,
    /// NUCLEO-G071RB.
    NucleoG071rb = 3,
}

/// What stands before a configuration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Header {
    /// The version of the layout.
    pub version: u16,
    /// The number of its board.
    pub board: u8,
    /// The number of its number format.
    pub format: u8,
    /// Bytes behind the header.
    pub length: u32,
    /// The CRC-32 (ISO-HDLC) of version, board, format, length and what is behind the header.
    pub crc: u32,
}

impl Header {
    /// That at the start of `bytes`.
    ///
    /// # Errors
    /// [`ConfigError::Absent`], [`ConfigError::Strange`].
    pub fn of(bytes: &[u8]) -> Result<Self, ConfigError> {
        let (words, _) = bytes.as_chunks::<4>();
        let &[magic, first, length, crc, ..] = words else {
            return Err(ConfigError::Absent);
        };
        match u32::from_le_bytes(magic) {
            MAGIC => {}
            ERASED => return Err(ConfigError::Absent),
            _ => return Err(ConfigError::Strange),
        }
        let [low, high, board, format] = first;
        Ok(Self {
            version: u16::from_le_bytes([low, high]),
            board,
            format,
            length: u32::from_le_bytes(length),
            crc: u32::from_le_bytes(crc),
        })
    }

    const fn bytes(&self) -> [u8; HEADER_BYTES] {
        let [m0, m1, m2, m3] = MAGIC.to_le_bytes();
        let [v0, v1] = self.version.to_le_bytes();
        let [l0, l1, l2, l3] = self.length.to_le_bytes();
        let [c0, c1, c2, c3] = self.crc.to_le_bytes();
        let (board, format) = (self.board, self.format);
        [
            m0, m1, m2, m3, v0, v1, board, format, l0, l1, l2, l3, c0, c1, c2, c3,
        ]
    }

    fn sum(&self, body: &[u8]) -> u32 {
        let bytes = self.bytes();
        let fields = crc32(0, bytes.get(4..12).unwrap_or_default());
        crc32(fields, body)
    }
}

/// Room for the bytes of a configuration.
pub type ConfigBytes = heapless::Vec<u8, CONFIG_BYTES>;

/// By pieces: a whole configuration by value is more than the stack of a board.
struct Parts<'b> {
    reader: Reader<'b>,
    refused: ConfigError,
}

/// Why stands in [`Parts`], so that what is asked after each piece is small.
struct Refused;

impl<'b> Parts<'b> {
    #[inline(never)]
    fn take<T: Deserialize<'b>>(&mut self, part: Part) -> Result<T, Refused> {
        match T::deserialize(&mut self.reader) {
            Ok(value) if self.reader.is_good() => Ok(value),
            _ => {
                self.refused = ConfigError::Unreadable(part);
                Err(Refused)
            }
        }
    }

    /// What is no ASCII becomes what a check refuses: to look for UTF-8 takes 624 bytes of flash.
    fn text(&mut self, place: &mut StringView) -> Result<(), Refused> {
        place.clear();
        let mut bytes = self.reader.slice().iter();
        let ascii = |byte: u8| if byte.is_ascii() { byte } else { 0 };
        let fits = bytes.all(|byte| place.push(ascii(*byte).into()).is_ok());
        if fits && self.reader.is_good() {
            Ok(())
        } else {
            self.refused = ConfigError::Unreadable(Part::Head);
            Err(Refused)
        }
    }

    /// Whether a part is there. An image that was built without it has no code to read it.
    fn has(&mut self, part: Part) -> Result<bool, Refused> {
        let is_there = self.take(part)?;
        if is_there && !part.is_built() {
            self.refused = ConfigError::NotBuilt(part);
            return Err(Refused);
        }
        Ok(is_there)
    }

    fn optional<T: Deserialize<'b>>(&mut self, part: Part) -> Result<Option<T>, Refused> {
        if self.has(part)? && part.is_built() {
            self.take(part).map(Some)
        } else {
            Ok(None)
        }
    }

    fn all<R: Real>(&mut self, config: &mut Config<R>) -> Result<(), Refused> {
        let head = &mut config.head;
        self.text(&mut head.name)?;
        self.text(&mut head.overrides)?;
        head.tick_hz = self.take(Part::Head)?;
        head.sides = self.take(Part::Head)?;
        head.whiskers_per_side = self.take(Part::Head)?;
        head.bus = self.optional(Part::Bus)?;
        config.sensor = self.take(Part::Sensor)?;
        config.links = self.take(Part::Links)?;
        config.contact = self.optional(Part::Contact)?;
        config.motion = None;
        if self.has(Part::Motion)? && Part::Motion.is_built() {
            self.motion(&mut config.motion)?;
        }
        config.classifier = self.optional(Part::Classifier)?;
        config.classes = self.optional(Part::Priors)?.unwrap_or_default();
        Ok(())
    }

    /// In the order of its fields.
    // Apart, so that little else is on the stack meanwhile.
    #[inline(never)]
    fn motion<R: Real>(&mut self, place: &mut Option<MotionConfig<R>>) -> Result<(), Refused> {
        let part = Part::Motion;
        *place = Some(MotionConfig {
            whisking: whisking::Config {
                oscillators: self.take(part)?,
                muscle: self.take(part)?,
                peak_gain: self.take(part)?,
                rcp: self.optional(Part::Rcp)?,
                cia: self.optional(Part::Cia)?,
                noise: self.optional(Part::Noise)?,
            },
            start: Start {
                sides: self.take(part)?,
                whiskers: self.take(part)?,
            },
            seed: self.take(part)?,
            servo: ServoConfig {
                pd: self.take(part)?,
                retry: self.take(part)?,
                guards: self.take(part)?,
                approach: self.take(part)?,
                homing: self.optional(Part::Homing)?,
            },
            driver: self.take(part)?,
            stops_all: self.take(part)?,
            arms_at_start: self.take(part)?,
        });
        Ok(())
    }
}

/// Reads and checks a configuration at the start of `bytes`, which may go on behind it.
///
/// # Errors
/// Why it is refused. Whatever the bytes, there is no panic.
pub fn decode<R: Real>(bytes: &[u8], board: BoardCode) -> Result<Config<R>, ConfigError> {
    let mut config = Config::still();
    decode_into(&mut config, bytes, board)?;
    Ok(config)
}

/// As [`decode`], part by part into a configuration that is there: for a board, whose stack has
/// no room for another. An image that takes none by a link ([`Part::TAKES_CONFIGURATIONS`]) checks
/// header and sum alone.
///
/// # Errors
/// As [`decode`]; then the configuration is of no use any more.
#[inline(never)]
pub fn decode_into<R: Real>(
    config: &mut Config<R>,
    bytes: &[u8],
    board: BoardCode,
) -> Result<(), ConfigError> {
    let mut parts = Parts {
        reader: Reader::new(body::<R>(bytes, board)?),
        refused: ConfigError::Strange,
    };
    if parts.all(config).is_err() {
        return Err(parts.refused);
    }
    if !Part::TAKES_CONFIGURATIONS {
        return Ok(());
    }
    config.check()?;
    // What is simulated cannot be harmed.
    if board == BoardCode::Simulation {
        return Ok(());
    }
    config.protects()
}

/// The parts, where the header says that they are whole, and for this program.
fn body<R: Real>(bytes: &[u8], board: BoardCode) -> Result<&[u8], ConfigError> {
    let header = Header::of(bytes)?;
    if header.version != VERSION {
        return Err(ConfigError::Version(header.version));
    }
    let length = header.length as usize;
    let body = bytes.get(HEADER_BYTES..).unwrap_or_default();
    let body = body.get(..length).ok_or(ConfigError::TooLong)?;
    if header.sum(body) != header.crc {
        return Err(ConfigError::Damaged);
    }
    if header.board != board as u8 {
        return Err(ConfigError::Board(header.board));
    }
    if header.format != R::FORMAT as u8 {
        return Err(ConfigError::Format(header.format));
    }
    Ok(body)
}

struct Writer<'b> {
    bytes: &'b mut [u8],
    length: usize,
}

impl Writer<'_> {
    fn part(&mut self, value: &impl Serialize) -> Result<(), ConfigError> {
        let room = self.bytes.get_mut(self.length..).unwrap_or_default();
        let written = postcard::to_slice(value, room);
        let written = written.map_err(|_| ConfigError::TooLong)?;
        self.length += written.len();
        Ok(())
    }

    fn optional(&mut self, value: Option<&impl Serialize>) -> Result<(), ConfigError> {
        self.part(&value.is_some())?;
        value.map_or(Ok(()), |value| self.part(value))
    }
}

/// A configuration for a board, as bytes.
///
/// # Errors
/// [`ConfigError::TooLong`].
pub fn encode<R: Real>(config: &Config<R>, board: BoardCode) -> Result<ConfigBytes, ConfigError> {
    let mut bytes = ConfigBytes::new();
    let room = bytes.resize(CONFIG_BYTES, 0);
    room.map_err(|_| ConfigError::TooLong)?;
    let mut writer = Writer {
        bytes: bytes.get_mut(HEADER_BYTES..).unwrap_or_default(),
        length: 0,
    };
    writer.part(&config.head)?;
    writer.part(&config.sensor)?;
    writer.part(&config.links)?;
    writer.optional(config.contact.as_ref())?;
    writer.optional(config.motion.as_ref())?;
    writer.optional(config.classifier.as_ref())?;
    writer.optional((!config.classes.is_empty()).then_some(&config.classes))?;
    let length = writer.length;
    bytes.truncate(HEADER_BYTES + length);
    let mut header = Header {
        version: VERSION,
        board: board as u8,
        format: R::FORMAT as u8,
        length: length as u32,
        crc: 0,
    };
    header.crc = header.sum(bytes.get(HEADER_BYTES..).unwrap_or_default());
    for (place, byte) in bytes.iter_mut().zip(header.bytes()) {
        *place = byte;
    }
    Ok(bytes)
}
