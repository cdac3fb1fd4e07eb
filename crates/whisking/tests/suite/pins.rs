//! Pins of a motor driver that keep their last value and write into a log.

use core::convert::Infallible;
use embedded_hal::digital::{self, InputPin, OutputPin};
use embedded_hal::pwm::{self, SetDutyCycle};
use std::cell::{Cell, RefCell};
use std::rc::Rc;
use whisking::motor::{Duty, SixStepConfig, StallConfig};

/// Counts of a PWM at full drive.
pub(crate) const MAX: u16 = 1000;

/// A driver that may jump about and stand still as a test likes.
pub(crate) const FREE_RUNNING: SixStepConfig = SixStepConfig {
    skip_limit: u8::MAX,
    stall: StallConfig {
        ticks: 1,
        threshold: Duty::FULL,
    },
    ..SixStepConfig::DEFAULT
};

/// What the pins of one driver have done, as words like `EN1=1` or `IN2=500`.
#[derive(Clone, Default)]
pub(crate) struct Log(Rc<RefCell<Vec<String>>>);

impl Log {
    pub(crate) fn take(&self) -> String {
        self.0.take().join(" ")
    }
}

/// A shared wire: a level or a duty.
#[derive(Clone, Default)]
pub(crate) struct Wire {
    pub(crate) value: Rc<Cell<u16>>,
    name: &'static str,
    log: Option<Log>,
}

impl Wire {
    pub(crate) fn new(name: &'static str, log: &Log) -> Self {
        Self {
            name,
            log: Some(log.clone()),
            ..Self::default()
        }
    }

    fn write(&self, value: u16) {
        self.value.set(value);
        if let Some(log) = &self.log {
            log.0.borrow_mut().push(format!("{}={value}", self.name));
        }
    }
}

impl digital::ErrorType for Wire {
    type Error = Infallible;
}

impl OutputPin for Wire {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.write(0);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.write(1);
        Ok(())
    }
}

impl InputPin for Wire {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.value.get() != 0)
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(self.value.get() == 0)
    }
}

impl pwm::ErrorType for Wire {
    type Error = Infallible;
}

impl SetDutyCycle for Wire {
    fn max_duty_cycle(&self) -> u16 {
        MAX
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        self.write(duty);
        Ok(())
    }
}
