//! Why a sensor that measures a magnet's tilt gives no words.

use core::fmt;

use tmag5170::{Register, ReplyError, StatusFaults};

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
            Self::Reply(
                ReplyError::Rejected | ReplyError::BadCrc { .. } | ReplyError::OtherType(_),
            ) => number::TILT_CHECK,
            Self::Reply(ReplyError::Restarted | ReplyError::Sensor(_))
            | Self::Reported(_)
            | Self::NotWritten(_) => number::TILT_REPORT,
            Self::NoMagnet => number::TILT_NO_MAGNET,
        }
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
