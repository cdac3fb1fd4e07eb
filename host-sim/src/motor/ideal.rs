//! A motor for the plant `ideal`, in which the angle is θ' exactly.

use std::sync::Arc;

use firmware::AngleInput;
use whisking::motor::{Duty, Fault, MotorDriver};

use super::pins::Level;

/// A motor that is always at its setpoint: the simulation puts it there. Clones are the same motor.
#[derive(Debug, Clone)]
pub struct IdealMotor {
    angle_deg: Arc<Level>,
    counts_per_deg: f64,
}

impl IdealMotor {
    /// A motor at rest whose angle input has `counts_per_deg` counts a degree.
    pub fn new(counts_per_deg: f64) -> Self {
        let motor = Self {
            angle_deg: Arc::default(),
            counts_per_deg,
        };
        motor.set_deg(whisking::REST_DEG);
        motor
    }

    /// Moves it.
    pub fn set_deg(&self, angle_deg: f64) {
        self.angle_deg.set(angle_deg);
    }
}

impl MotorDriver for IdealMotor {
    fn drive(&mut self, _duty: Duty) -> Result<(), Fault> {
        Ok(())
    }

    fn off(&mut self) {}

    fn clear(&mut self) {}
}

impl AngleInput for IdealMotor {
    fn counts(&mut self) -> i32 {
        ((self.angle_deg.get() - whisking::REST_DEG) * self.counts_per_deg).round() as i32
    }
}
