//! Pins of a motor driver that keep their last value, write into a log, and fail when asked to.

use embedded_hal::digital::{self, InputPin, OutputPin};
use embedded_hal::pwm::{self, SetDutyCycle};
use embedded_hal_mock::eh1::MockError;
use std::cell::{Cell, RefCell};
use std::io::ErrorKind;
use std::rc::Rc;
use whisking::motor::{Duty, HBridge, MotorDriver, SixStep, SixStepConfig, StallConfig};

/// Counts of a PWM at full drive.
pub(crate) const MAX: u16 = 1000;
pub(crate) const HALF: Duty = Duty::from_q15(16_384);
pub(crate) const MINUS_HALF: Duty = Duty::from_q15(-16_384);

/// A driver that may jump about and stand still as a test likes.
pub(crate) const FREE_RUNNING: SixStepConfig = SixStepConfig {
    skip_limit: u8::MAX,
    stall: StallConfig {
        ticks: 1,
        threshold: Duty::FULL,
    },
};

/// Hall codes in the order in which a forward rotor shows them, from sector 0 on.
pub(crate) const CODES: [u8; 6] = [1, 3, 2, 6, 4, 5];

/// What the pins of one driver have done, as words like `EN1=1` or `IN2=500`; with `!` those
/// that failed.
#[derive(Clone, Default)]
struct Log(Rc<RefCell<Vec<String>>>);

/// A shared wire: a level or a duty.
#[derive(Clone, Default)]
pub(crate) struct Wire {
    pub(crate) value: Rc<Cell<u16>>,
    /// Counts at full drive, where they are not [`MAX`].
    pub(crate) max: Rc<Cell<Option<u16>>>,
    /// Which of the next reads or writes fail, the first in the lowest bit.
    failing: Rc<Cell<u32>>,
    name: &'static str,
    log: Log,
}

impl Wire {
    fn new(name: &'static str, log: &Log) -> Self {
        Self {
            name,
            log: log.clone(),
            ..Self::default()
        }
    }

    /// Whether this access works.
    fn access(&self) -> Result<(), MockError> {
        let failing = self.failing.get();
        self.failing.set(failing >> 1);
        if failing & 1 == 0 {
            Ok(())
        } else {
            Err(MockError::Io(ErrorKind::NotConnected))
        }
    }

    fn write(&self, value: u16) -> Result<(), MockError> {
        let result = self.access();
        let mark = if result.is_ok() { "" } else { "!" };
        let word = format!("{}={value}{mark}", self.name);
        self.log.0.borrow_mut().push(word);
        result.map(|()| self.value.set(value))
    }
}

impl digital::ErrorType for Wire {
    type Error = MockError;
}

impl OutputPin for Wire {
    fn set_low(&mut self) -> Result<(), MockError> {
        self.write(0)
    }

    fn set_high(&mut self) -> Result<(), MockError> {
        self.write(1)
    }
}

impl InputPin for Wire {
    fn is_high(&mut self) -> Result<bool, MockError> {
        self.access().map(|()| self.value.get() != 0)
    }

    fn is_low(&mut self) -> Result<bool, MockError> {
        self.is_high().map(|is_high| !is_high)
    }
}

impl pwm::ErrorType for Wire {
    type Error = MockError;
}

impl SetDutyCycle for Wire {
    fn max_duty_cycle(&self) -> u16 {
        self.max.get().unwrap_or(MAX)
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), MockError> {
        self.write(duty)
    }
}

/// A driver with its outputs, and the Hall sensors of a motor behind it.
pub(crate) struct Bench<D> {
    log: Log,
    pub(crate) driver: D,
    pub(crate) outputs: Vec<Wire>,
    pub(crate) halls: [Wire; 3],
}

impl<D> Bench<D> {
    /// Of outputs with these names, of which those in `failing` fail at once.
    fn new<const N: usize>(
        names: [&'static str; N],
        failing: &str,
        driver: impl FnOnce(&[Wire; N], &[Wire; 3]) -> D,
    ) -> Self {
        let (log, halls) = (Log::default(), <[Wire; 3]>::default());
        let outputs = names.map(|name| Wire::new(name, &log));
        for output in outputs.iter().filter(|output| output.name == failing) {
            output.failing.set(1);
        }
        let driver = driver(&outputs, &halls);
        Self {
            log,
            driver,
            outputs: outputs.into(),
            halls,
        }
    }

    pub(crate) fn output(&self, name: &str) -> &Wire {
        let mut outputs = self.outputs.iter();
        outputs.find(|output| output.name == name).unwrap()
    }

    /// Lets some of the next writes to an output fail, the first in the lowest bit.
    pub(crate) fn fail(&self, name: &str, which: u32) {
        self.output(name).failing.set(which);
    }

    pub(crate) fn written(&self) -> String {
        self.log.0.take().join(" ")
    }

    pub(crate) fn turn(&self, code: u8) {
        for (bit, hall) in self.halls.iter().enumerate() {
            hall.value.set(u16::from(code >> bit & 1));
        }
    }

    pub(crate) fn unreadable(&self) {
        self.halls[0].failing.set(1);
    }

    pub(crate) fn map(self, change: impl FnOnce(D) -> D) -> Self {
        Self {
            driver: change(self.driver),
            ..self
        }
    }
}

impl<D: MotorDriver> Bench<D> {
    pub(crate) fn drive(&mut self, duty: Duty) -> String {
        self.driver.drive(duty).unwrap();
        self.written()
    }

    /// The fault in which a drive ends, and what it writes.
    pub(crate) fn fails(&mut self, duty: Duty) -> String {
        let fault = self.driver.drive(duty).unwrap_err();
        format!("{fault:?} {}", self.written())
    }

    pub(crate) fn off(&mut self) -> String {
        self.driver.off();
        self.written()
    }
}

/// A bridge whose start has been read from the log, where its PWM may have failed.
pub(crate) fn bridge(failing: &str) -> Bench<HBridge<Wire, Wire>> {
    let bench = Bench::new(["PWM", "DIR"], failing, |[pwm, dir], _| {
        HBridge::new(pwm.clone(), dir.clone())
    });
    let mark = if failing.is_empty() { "" } else { "!" };
    assert_eq!(bench.written(), format!("PWM=0{mark}"));
    bench
}

pub(crate) type Motor = Bench<SixStep<Wire, Wire, Wire>>;

/// A six-step driver in sector 0, with its start in the log still.
pub(crate) fn six_step(config: SixStepConfig, failing: &str) -> Motor {
    let names = ["IN1", "IN2", "IN3", "EN1", "EN2", "EN3"];
    let bench = Bench::new(names, failing, |outputs, halls| {
        let [in1, in2, in3, en1, en2, en3] = outputs.clone();
        SixStep::new([in1, in2, in3], [en1, en2, en3], halls.clone(), config)
    });
    bench.turn(1);
    bench
}
