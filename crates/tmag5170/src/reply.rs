//! What comes back: status bits and a register.
//!
//! | bits | 31..28 | 27..24 | 23..20 | 19..16 | 15..12 | 11..8 | 7..4 | 3..0 |
//! |---|---|---|---|---|---|---|---|---|
//! | register | S11..S8 | S7..S4 | value 15..12 | 11..8 | 7..4 | 3..0 | S3..S0 | CRC |
//!
//! Every source agrees on this. A sensor that is asked to sends two channels at once in another
//! layout; here none is asked.

use core::fmt;

use crate::FRAME_LEN;
use crate::crc::{self, crc4};

/// The twelve status bits of a reply.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Status(u16);

impl Status {
    /// S11: the command before this one came with wrong check bits.
    pub const PREVIOUS_CRC: Status = Status(0x800);
    /// S10: the sensor has restarted, and AFE_STATUS has not been read since.
    pub const RESTARTED: Status = Status(0x400);
    /// S9: a bit of SYS_STATUS is set. TI's forum and Kharim234's decoder; light655's library
    /// has S9 and S8 the other way round.
    pub const SYSTEM: Status = Status(0x200);
    /// S8: a bit of AFE_STATUS is set, other than the one of a restart.
    pub const AFE: Status = Status(0x100);
    /// S3: some fault.
    pub const ERROR: Status = Status(0x008);

    /// From its bits, of which the upper four do not count. Bits 7 to 4 are about X, Y, Z and
    /// the temperature; sources disagree on what (new in this conversion, or beyond a
    /// threshold), and nothing here uses them.
    pub const fn new(bits: u16) -> Status {
        Status(bits & 0x0FFF)
    }

    /// Its bits.
    pub const fn bits(self) -> u16 {
        self.0
    }

    /// Whether every bit of `other` is set.
    pub const fn contains(self, other: Status) -> bool {
        self.0 & other.0 == other.0
    }

    /// S2..S0, 0..=7: how many sets have been converted.
    pub const fn count(self) -> u16 {
        self.0 & 0x007
    }
}

/// Why a reply is no reading. In the order in which they are looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ReplyError {
    /// All bits one. Likely cause: no sensor, no supply, or a cut wire, on a line with a pull-up.
    NoSensor,
    /// All bits zero. Likely cause: the same on a line without one, or SDO shorted.
    LineLow,
    /// The last bit alone is wrong: the sensor has found wrong check bits in the command,
    /// and has not obeyed it. Likely cause: noise on SDI or SCK, a clock too fast.
    Rejected,
    /// The check bits are wrong. Likely cause: noise on SDO or SCK, a clock too fast.
    BadCrc {
        /// What the frame wants.
        expected: u8,
        /// What it has.
        found: u8,
    },
    /// The sensor has restarted: its settings are gone. Likely cause: a supply that broke
    /// down. Configure it again.
    Restarted,
    /// The sensor reports a fault; [`Tmag5170::faults`](crate::Tmag5170::faults) has which.
    Sensor(Status),
}

impl fmt::Display for ReplyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ReplyError::NoSensor => f.write_str("no sensor: all bits one"),
            ReplyError::LineLow => f.write_str("data line stuck low: all bits zero"),
            ReplyError::Rejected => f.write_str("the sensor found a wrong CRC in the command"),
            ReplyError::BadCrc { expected, found } => {
                write!(f, "bad CRC: {found:#03x}, expected {expected:#03x}")
            }
            ReplyError::Restarted => f.write_str("the sensor has restarted"),
            ReplyError::Sensor(Status(bits)) => {
                write!(f, "the sensor reports a fault: status {bits:#05x}")
            }
        }
    }
}

impl core::error::Error for ReplyError {}

/// Whether a reply arrived whole.
///
/// A single wrong bit that the check bits place as the last one reads as
/// [`ReplyError::Rejected`] instead of [`ReplyError::BadCrc`]: three of the 32 do.
///
/// # Errors
/// The first four of [`ReplyError`], in their order.
pub const fn check(bytes: &[u8; FRAME_LEN]) -> Result<(), ReplyError> {
    match u32::from_be_bytes(*bytes) {
        u32::MAX => return Err(ReplyError::NoSensor),
        0 => return Err(ReplyError::LineLow),
        _ => {}
    }
    let [expected, found] = [crc4(bytes), crc::found(*bytes)];
    match expected ^ found {
        0 => Ok(()),
        1 => Err(ReplyError::Rejected),
        _ => Err(ReplyError::BadCrc { expected, found }),
    }
}

/// A reply that carries a register.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Reply {
    /// All twelve status bits.
    pub status: Status,
    /// What the register holds; 0 where the command wrote one.
    pub value: u16,
}

impl Reply {
    /// Decodes a reply, whatever its status says. Any four bytes give an answer.
    ///
    /// # Errors
    /// As [`check`].
    pub fn decode(bytes: &[u8; FRAME_LEN]) -> Result<Reply, ReplyError> {
        check(bytes)?;
        let [first, high, low, last] = *bytes;
        Ok(Reply {
            status: Status::new((u16::from(first) << 4) | u16::from(last >> 4)),
            value: u16::from_be_bytes([high, low]),
        })
    }

    /// The value, if the status has no fault.
    ///
    /// # Errors
    /// [`ReplyError::Restarted`] or [`ReplyError::Sensor`]. That an earlier command was
    /// rejected is none: the reply to that one said so.
    pub const fn trusted(self) -> Result<u16, ReplyError> {
        if self.status.contains(Status::RESTARTED) {
            Err(ReplyError::Restarted)
        } else if self.status.contains(Status::ERROR) {
            Err(ReplyError::Sensor(self.status))
        } else {
            Ok(self.value)
        }
    }
}
