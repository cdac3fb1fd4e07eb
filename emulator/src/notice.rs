//! Faults that a module reports, and their ends.

use firmware::{Event, Place};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Notice {
    /// The sensor of a whisker has a fault: its motor is off.
    SensorLost,
    SensorBack,
    MotorFault,
    MotorRetry,
    MotorGivenUp,
}

impl Notice {
    pub(crate) fn of(event: &Event) -> Option<(Place, Self)> {
        match *event {
            Event::SensorLost(place, _) => Some((place, Self::SensorLost)),
            Event::SensorBack(place) => Some((place, Self::SensorBack)),
            Event::MotorFault(place, _) => Some((place, Self::MotorFault)),
            Event::MotorRetry(place) => Some((place, Self::MotorRetry)),
            Event::MotorGivenUp(place) => Some((place, Self::MotorGivenUp)),
            _ => None,
        }
    }
}
