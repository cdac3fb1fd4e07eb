//! What a simulated module is made of.

use firmware::{Clock, Hardware};

use super::sensor::AnySensor;
use crate::classifier::Tap;
use crate::drive::{AnyAngle, AnyMotor};

/// Time does not pass within a tick of the simulation.
#[derive(Debug, Clone, Copy)]
pub struct NoClock;

impl Clock for NoClock {
    fn now(&mut self) -> u32 {
        0
    }
}

pub(super) struct Mock;

impl Hardware for Mock {
    type Source = AnySensor;
    type Motor = AnyMotor;
    type Angle = AnyAngle;
    type Classifier = Tap;
    type Clock = NoClock;
}
