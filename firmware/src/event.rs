//! What a tick reports. Events are small values; whoever drains the queue formats them.

#[cfg(feature = "tmag5170")]
mod tilt_fault;

use core::fmt;

use mlx90333::{FRAME_LEN, FrameError};
use tactile::{Decision, Pose};
use whisking::motor;

use crate::faults::{name, number};
#[cfg(feature = "tmag5170")]
pub use tilt_fault::TiltFault;

/// A whisker of the array.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    /// 0 left, 1 right.
    pub side: u8,
    /// Counted from 0.
    pub whisker: u8,
}

impl Place {
    /// Of this side and number.
    pub const fn new(side: u8, whisker: u8) -> Self {
        Self { side, whisker }
    }

    /// The word for its side.
    pub const fn side_name(self) -> &'static str {
        if self.side == 0 { "left" } else { "right" }
    }
}

/// As people count: `left whisker 2`, from 1 on each side.
impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = u16::from(self.whisker) + 1;
        write!(f, "{} whisker {number}", self.side_name())
    }
}

/// Why a whisker's readings cannot be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SensorFault {
    /// No frame was finished in time.
    NoFrame,
    /// The bus controller reported an error.
    Bus,
    /// The frame was refused; the reason says more.
    Frame(FrameError),
    /// Its words repeat to the bit for longer than the noise of a sensor lets them.
    Frozen,
    /// Its words jump about farther than a whisker can move.
    Jump,
    /// Ticks without a good frame are too many, if never too many in succession. With the
    /// number of what was wrong with the last.
    Often(u8),
    /// A magnet's tilt is not measured. The last, as programs without it number the others alike.
    #[cfg(feature = "tmag5170")]
    Tilt(TiltFault),
}

impl SensorFault {
    /// Its number in the [table](crate::faults).
    // Apart: together with another match the compiler makes a jump that traps where it cannot come.
    #[inline(never)]
    pub const fn code(self) -> u8 {
        match self {
            Self::NoFrame => number::NO_FRAME,
            Self::Bus => number::BUS,
            Self::Frame(FrameError::NoSensor) => number::NO_SENSOR,
            Self::Frame(FrameError::LineLow) => number::LINE_LOW,
            Self::Frame(FrameError::BadStart(_)) => number::BAD_START,
            Self::Frame(FrameError::BadSum { .. }) => number::BAD_SUM,
            Self::Frame(FrameError::Sensor(_)) => number::SENSOR_REPORT,
            Self::Frame(FrameError::StuckWords) => number::STUCK_WORDS,
            #[cfg(feature = "tmag5170")]
            Self::Tilt(fault) => fault.code(),
            Self::Frozen => number::FROZEN,
            Self::Jump => number::JUMP,
            Self::Often(_) => number::OFTEN,
        }
    }
}

/// The name in the [table](crate::faults), and what was found instead of what was due.
impl fmt::Display for SensorFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(name(self.code()))?;
        match self {
            Self::Frame(FrameError::BadStart(found)) => write!(f, ": {found:#04x}"),
            Self::Frame(FrameError::BadSum { expected, found }) => {
                write!(f, ": {found:#04x} instead of {expected:#04x}")
            }
            Self::Frame(FrameError::Sensor(reported)) => write!(f, ": {reported}"),
            #[cfg(feature = "tmag5170")]
            Self::Tilt(fault) => write!(f, ": {fault}"),
            Self::Often(last) => write!(f, ", the last: {}", name(*last)),
            _ => Ok(()),
        }
    }
}

impl core::error::Error for SensorFault {}

/// Something worth a line in the log. The last four are the board's own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Event {
    /// A whisker touches something.
    Touch {
        /// Which one.
        place: Place,
        /// The number of the touch, from 1.
        number: u16,
    },
    /// It has not touched anything for a while.
    TouchEnd {
        /// Which one.
        place: Place,
        /// The number of the touch that has ended.
        number: u16,
    },
    /// By the samples of this whisker, or of all together: then by a block of this one.
    Decision(Place, Decision),
    /// How what was named stands, after its decision.
    Pose(Place, Pose),
    /// Readings of a whisker have been bad for longer than they may be: its
    /// motor is off (fault) and it touches nothing.
    SensorLost(Place, SensorFault),
    /// The last frame of a sensor that is lost for its frames, as it came.
    Frame(Place, [u8; FRAME_LEN]),
    /// Readings are good again; the whisker moves again.
    SensorBack(Place),
    /// The zero of a sensor was moved: to so many codes from mid-scale, x and y.
    ZeroMoved(Place, [i16; 2]),
    /// A motor was switched off (fault): its whisker touches nothing while it rests.
    MotorFault(Place, motor::Fault),
    /// A motor is tried again after its rest.
    MotorRetry(Place),
    /// A motor has had too many faults: it stays off until it is cleared
    /// ([`Command::Clear`](crate::Command::Clear)).
    MotorGivenUp(Place),
    /// What has become of a board of a head, by what this one, of that number, says.
    Node(u8, NodeEvent),
    /// The user button has armed the motors.
    Armed,
    /// The user button has stopped the motors.
    Stopped,
    /// Once a second: how the ticks keep their time.
    Health(Health),
    /// A limit with this number in the [table](crate::faults) was passed.
    Limit(u8),
}

/// What becomes of a board of a head.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NodeEvent {
    /// It shares clock and oscillators of its head.
    Joined,
    /// It does so no longer: its clock is another than that of a lower node.
    Left,
    /// It hears another, for the first time or again.
    Heard(u8),
    /// It does not hear another any more.
    Lost(u8),
    /// Another has its number (fault): its motors stay off, and it is silent.
    Twin,
}

impl NodeEvent {
    /// As it is sent: a number, and which other board.
    pub(crate) const fn code(self) -> [u8; 2] {
        match self {
            Self::Joined => [0, 0],
            Self::Left => [1, 0],
            Self::Heard(other) => [2, other],
            Self::Lost(other) => [3, other],
            Self::Twin => [4, 0],
        }
    }

    pub(crate) const fn of([code, other]: [u8; 2]) -> Option<Self> {
        Some(match code {
            0 => Self::Joined,
            1 => Self::Left,
            2 => Self::Heard(other),
            3 => Self::Lost(other),
            4 => Self::Twin,
            _ => return None,
        })
    }
}

/// How the ticks keep their time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Health {
    /// The longest tick of the last second, tenths of a microsecond.
    pub worst_tenths: u16,
    /// Ticks that did not happen in time, since the start.
    pub missed: u32,
    /// Events that found their queue full, since the start.
    pub dropped: u32,
}
