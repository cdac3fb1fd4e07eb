//! What a tick reports. Events are small values; whoever drains the queue
//! formats them.

use mlx90333::FrameError;
use tactile::Decision;
use whisking::motor;

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

/// Why a whisker's readings cannot be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum SensorFault {
    /// No frame was finished in time. Likely cause: the bus is too slow for
    /// the tick, or its DMA stands still.
    #[error("no frame in time")]
    NoFrame,
    /// The bus controller reported an error.
    #[error("bus error")]
    Bus,
    /// The frame was refused; the reason names the cause.
    #[error("{0}")]
    Frame(FrameError),
}

impl SensorFault {
    /// A stable number for logs: 16 no frame, 17 bus, 18 no sensor, 19 line
    /// stuck low, 20 bad start, 21 bad sum, 22 the sensor's own error word.
    /// Motor faults have 1 to 11 ([`motor::Fault::code`]).
    pub const fn code(self) -> u8 {
        match self {
            Self::NoFrame => 16,
            Self::Bus => 17,
            Self::Frame(FrameError::NoSensor) => 18,
            Self::Frame(FrameError::LineLow) => 19,
            Self::Frame(FrameError::BadStart(_)) => 20,
            Self::Frame(FrameError::BadSum { .. }) => 21,
            Self::Frame(FrameError::Sensor(_)) => 22,
        }
    }
}

/// Something worth a line in the log.
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
    /// A decision fell, by the samples of this whisker, or of all together: then by a
    /// block of this one.
    Decision(Place, Decision),
    /// Readings of a whisker have been bad for longer than they may be: its
    /// motor is off (fault) and it touches nothing.
    SensorLost(Place, SensorFault),
    /// Readings are good again; the whisker moves again.
    SensorBack(Place),
    /// A motor was switched off (fault): its whisker touches nothing while it rests.
    MotorFault(Place, motor::Fault),
    /// A motor is tried again after its rest.
    MotorRetry(Place),
    /// A motor has had too many faults: it stays off until it is told to run
    /// ([`Command::Clear`](crate::Command::Clear)).
    MotorGivenUp(Place),
}
