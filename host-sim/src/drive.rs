//! The module's side of a motor: the firmware's driver and angle input on simulated pins.

use firmware::AngleInput;
use whisking::motor::{Duty, Fault, HBridge, MotorDriver, SixStep, SixStepConfig, StallConfig};

use crate::motor::Pins;

/// Any motor driver.
pub struct AnyMotor(Box<dyn MotorDriver + Send>);

impl MotorDriver for AnyMotor {
    fn drive(&mut self, duty: Duty) -> Result<(), Fault> {
        self.0.drive(duty)
    }

    fn off(&mut self) {
        self.0.off();
    }

    fn clear(&mut self) {
        self.0.clear();
    }
}

/// Any angle input.
pub struct AnyAngle(Box<dyn AngleInput + Send>);

impl AngleInput for AnyAngle {
    fn counts(&mut self) -> i32 {
        self.0.counts()
    }
}

/// The firmware's driver and angle input on these pins, set up as on a board.
pub fn on(pins: Pins, stall: StallConfig) -> (AnyMotor, AnyAngle) {
    match pins {
        Pins::Ideal(motor) => (AnyMotor(Box::new(motor.clone())), AnyAngle(Box::new(motor))),
        Pins::Brushed(pins) => {
            let driver = HBridge::new(pins.pwm, pins.dir).with_buffered_pwm();
            (AnyMotor(Box::new(driver)), AnyAngle(Box::new(pins.encoder)))
        }
        Pins::Brushless(pins) => {
            let usual = SixStepConfig::DEFAULT;
            let config = SixStepConfig { stall, ..usual };
            let driver = SixStep::new(pins.pwms, pins.enables, pins.halls, config);
            let driver = driver.with_buffered_pwm();
            (AnyMotor(Box::new(driver)), AnyAngle(Box::new(pins.encoder)))
        }
    }
}
