//! A whole active module on hardware that is only memory: its sensors, motors,
//! encoders and clock are fields, as they are registers on a board.

use core::convert::Infallible;

use embedded_hal::digital::{self, OutputPin};
use embedded_hal::pwm::{self, SetDutyCycle};
use firmware::{
    AngleInput, BusError, Clock, CodeClassifier, Config, Event, FrameSource, Hardware, Module,
    WhiskerParts,
};
use mlx90333::FRAME_LEN;
use tactile::{Model, StreamClassifier};
use whisking::Number;
use whisking::motor::HBridge;

use crate::listener::open_9;
use crate::samples::frame;

/// Counts of the clock between two ticks.
const PERIOD: u32 = 45_000;

/// A sensor that has a new frame in every tick.
#[derive(Debug)]
pub struct Frames {
    next: u32,
}

impl FrameSource for Frames {
    #[inline]
    fn take(&mut self) -> Result<Option<[u8; FRAME_LEN]>, BusError> {
        self.next += 1;
        Ok(Some(*frame(self.next)))
    }
}

/// The compare register of a PWM.
#[derive(Debug)]
pub struct Compare(u16);

impl pwm::ErrorType for Compare {
    type Error = Infallible;
}

impl SetDutyCycle for Compare {
    #[inline]
    fn max_duty_cycle(&self) -> u16 {
        2250
    }

    #[inline]
    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        self.0 = duty;
        Ok(())
    }
}

/// The output register of a pin.
#[derive(Debug)]
pub struct Pin(bool);

impl digital::ErrorType for Pin {
    type Error = Infallible;
}

impl OutputPin for Pin {
    #[inline]
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0 = false;
        Ok(())
    }

    #[inline]
    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0 = true;
        Ok(())
    }
}

/// The counter of an encoder, which turns on.
#[derive(Debug)]
pub struct Encoder(i32);

impl AngleInput for Encoder {
    #[inline]
    fn counts(&mut self) -> i32 {
        self.0 += 2;
        self.0
    }
}

/// A counter that runs.
#[derive(Debug)]
pub struct Counter(u32);

impl Clock for Counter {
    #[inline]
    fn now(&mut self) -> u32 {
        self.0 = self.0.wrapping_add(PERIOD / 2);
        self.0
    }
}

/// All of these.
pub struct Memory;

impl Hardware for Memory {
    type Source = Frames;
    type Motor = HBridge<Compare, Pin>;
    type Angle = Encoder;
    type Classifier = CodeClassifier;
    type Clock = Counter;
}

/// A module with a classifier of nine classes, and the last event that it reported.
pub struct Whole<R: Number> {
    module: Module<R, Memory>,
    reported: Option<Event>,
}

impl<R: Number> Whole<R> {
    /// A module that has not ticked yet.
    ///
    /// # Panics
    /// If the build script has made another model, or another configuration, than this needs.
    pub fn new(config: &Config<R>) -> Self {
        let whiskers = config.head.whiskers();
        let parts = (0..whiskers).map(|n| WhiskerParts {
            source: Frames { next: n as u32 },
            motor: Some((
                HBridge::new(Compare(0), Pin(false)).with_buffered_pwm(),
                Encoder(0),
            )),
        });
        let model = Model::parse(open_9()).expect("a model");
        let (rule, deciding) = config
            .classifier
            .and_then(|classifier| Some((classifier.rule?, classifier.deciding)))
            .expect("a rule");
        let classifier = StreamClassifier::new(model, rule, deciding, whiskers);
        let classifier = CodeClassifier::new(classifier.expect("any model has this rule"));
        let classifier = classifier.expect("learnt from codes");
        let mut module = Module::new(config, parts, Some(classifier), (Counter(0), PERIOD));
        module.arm(true);
        Self {
            module,
            reported: None,
        }
    }

    /// One tick.
    #[inline]
    pub fn tick(&mut self, config: &Config<R>) {
        let reported = &mut self.reported;
        self.module
            .tick(config, &mut |event| *reported = Some(event));
    }
}

#[cfg(test)]
mod tests {
    use super::Whole;
    use crate::format::{Format, config};
    use crate::report::CALLS;

    #[test]
    fn what_is_counted_is_a_tick_in_which_all_is_well() {
        fn run<R: Format>() {
            let config = config::<R>(R::LONE);
            let mut whole = Whole::new(&config);
            for _ in 0..CALLS {
                whole.tick(&config);
                assert_eq!(whole.reported, None);
            }
            assert!(whole.module.contact()[0].to_f64() > 0.0);
        }
        crate::each_format!(run);
    }
}
