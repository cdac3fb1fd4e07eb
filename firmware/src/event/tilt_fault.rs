//! Why a sensor that measures a magnet's tilt gives no words.

use core::fmt;

use tmag5170::{Register, ReplyError, Status, StatusFaults};

use crate::faults::number;

/// What a TMAG5170 lets a whisker down by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TiltFault {
    /// Its reply was refused; the reason says more.
    Reply(ReplyError),
    /// It reports this about itself.
    Reported(StatusFaults),
    /// It does not take this setting.
    NotWritten(Register),
    /// It finds no field along Z.
    NoMagnet,
}

impl TiltFault {
    /// Its number in the [table](crate::faults).
    pub const fn code(self) -> u8 {
        match self {
            Self::Reply(ReplyError::NoSensor) => number::TILT_NO_SENSOR,
            Self::Reply(ReplyError::LineLow) => number::TILT_LINE_LOW,
            Self::Reply(ReplyError::Rejected | ReplyError::BadCrc { .. }) => number::TILT_CHECK,
            Self::Reply(ReplyError::Restarted | ReplyError::Sensor(_))
            | Self::Reported(_)
            | Self::NotWritten(_) => number::TILT_REPORT,
            Self::NoMagnet => number::TILT_NO_MAGNET,
        }
    }
}

/// Of faults that share a number, which one it is, as it is sent.
mod which {
    pub(super) const REJECTED: u32 = 0;
    pub(super) const BAD_CRC: u32 = 1;
    pub(super) const RESTARTED: u32 = 0;
    pub(super) const STATUS: u32 = 1;
    pub(super) const REPORTED: u32 = 2;
    pub(super) const NOT_WRITTEN: u32 = 3;
}

impl TiltFault {
    /// What is known of it besides its number, as it is sent.
    pub(crate) const fn values(self) -> [u32; 2] {
        match self {
            Self::Reply(ReplyError::NoSensor | ReplyError::LineLow) | Self::NoMagnet => [0; 2],
            Self::Reply(ReplyError::Rejected) => [which::REJECTED, 0],
            Self::Reply(ReplyError::BadCrc { expected, found }) => {
                [which::BAD_CRC, u16::from_le_bytes([expected, found]) as u32]
            }
            Self::Reply(ReplyError::Restarted) => [which::RESTARTED, 0],
            Self::Reply(ReplyError::Sensor(status)) => [which::STATUS, status.bits() as u32],
            Self::Reported(faults) => {
                let bits = (faults.afe_status() as u32) << 16 | faults.sys_status() as u32;
                [which::REPORTED, bits]
            }
            Self::NotWritten(register) => [which::NOT_WRITTEN, register.address() as u32],
        }
    }

    /// The fault of a number with these values; `None`: it is none of these.
    pub(crate) fn of(number: u8, [which, value]: [u32; 2]) -> Option<Self> {
        let [low, high, ..] = value.to_le_bytes();
        let reply = match (number, which) {
            (number::TILT_NO_SENSOR, _) => ReplyError::NoSensor,
            (number::TILT_LINE_LOW, _) => ReplyError::LineLow,
            (number::TILT_CHECK, which::REJECTED) => ReplyError::Rejected,
            (number::TILT_CHECK, which::BAD_CRC) => ReplyError::BadCrc {
                expected: low,
                found: high,
            },
            (number::TILT_REPORT, which::RESTARTED) => ReplyError::Restarted,
            (number::TILT_REPORT, which::STATUS) => ReplyError::Sensor(Status::new(value as u16)),
            (number::TILT_REPORT, which::REPORTED) => {
                let faults = StatusFaults::new((value >> 16) as u16, value as u16);
                return Some(Self::Reported(faults));
            }
            (number::TILT_REPORT, which::NOT_WRITTEN) => {
                return Register::at(low).map(Self::NotWritten);
            }
            (number::TILT_NO_MAGNET, _) => return Some(Self::NoMagnet),
            _ => return None,
        };
        Some(Self::Reply(reply))
    }
}

impl fmt::Display for TiltFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Reply(error) => error.fmt(f),
            Self::Reported(faults) => faults.fmt(f),
            Self::NotWritten(register) => write!(f, "{register:?} is not taken"),
            Self::NoMagnet => f.write_str("no field along Z"),
        }
    }
}
