//! A whole active module on hardware that is only memory: its sensors, motors,
//! encoders and clock are fields, as they are registers on a board.

use core::convert::Infallible;

use embedded_hal::digital::{self, OutputPin};
use embedded_hal::pwm::{self, SetDutyCycle};
use firmware::design_parameters::{Plausible, retry, sensor_limits};
use firmware::{
    Active, ActiveConfig, AngleInput, BusError, Classifying, ClassifyingConfig, Clock,
    CodeClassifier, Config, Event, FrameSource, Module, Servo, ServoConfig,
};
use mlx90333::{Decoder, FRAME_LEN};
use tactile::{Model, Sequential, Threshold};
use whisking::motor::HBridge;
use whisking::{Absent, Present, Start, State, filter, muscle, oscillator};

use crate::format::{Format, Generator};
use crate::listener::{THRESHOLD, open_9};
use crate::samples::frame;

/// Ticks a second.
const TICK_HZ: u32 = 2000;
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

type Motor = HBridge<Compare, Pin>;
type Motion<R, const S: usize, const N: usize> = Active<R, Motor, Encoder, S, N>;
type Perception = Classifying<CodeClassifier<Sequential>>;

type Whisking<R> = Generator<R, oscillator::Exact<R>, muscle::Exact<R>>;
type Settings<R> = Config<
    ActiveConfig<R, Whisking<R>>,
    ClassifyingConfig<Absent, Threshold>,
    Present<filter::Config<R>>,
>;

/// A module and the last event that it told.
#[derive(Debug)]
pub struct Whole<R: Format, const S: usize, const N: usize> {
    module: Module<R, Frames, Motion<R, S, N>, Perception, Counter, S, N>,
    settings: Settings<R>,
    told: Option<Event>,
}

impl<R: Format, const S: usize, const N: usize> Whole<R, S, N> {
    /// Frame, contact filter, RCP, CIA, oscillators, muscles, position control
    /// and a classifier of nine classes; no noise, which few scenes have.
    const SETTINGS: Settings<R> = Config {
        decoder: Decoder::new(),
        // The samples are not a whisker's course; what is compared is the same.
        sensor_limits: sensor_limits(TICK_HZ, Plausible::ANY),
        contact: Present(*R::H50),
        motion: ActiveConfig {
            whisking: *R::WHISKING,
            servo: ServoConfig {
                pd: *R::PD,
                retry: retry(TICK_HZ),
                guards: *R::GUARDS,
                approach: R::ONE,
                homing: Absent,
            },
            stop_all: Absent,
        },
        perception: ClassifyingConfig {
            contact_min: Absent,
            rule: THRESHOLD,
        },
        period: PERIOD,
    };

    /// A module that has not ticked yet.
    ///
    /// # Panics
    /// If the build script made another model than this needs.
    pub fn new(start: &Start<R, S, N>) -> Self {
        let model = Model::parse(open_9()).expect("a model");
        let classifier = Sequential::new(model, THRESHOLD).expect("any model has this rule");
        let stream = CodeClassifier::new(classifier).expect("learnt from codes");
        let servos = core::array::from_fn(|_| {
            core::array::from_fn(|_| {
                let motor = HBridge::new(Compare(0), Pin(false)).with_buffered_pwm();
                Servo::new(motor, Encoder(0))
            })
        });
        let sources = core::array::from_fn(|side| {
            core::array::from_fn(|w| Frames {
                next: (side + w) as u32,
            })
        });
        let motion = Active::new(State::new(start, 1), servos);
        let mut module = Module::new(sources, motion, Classifying::new(stream), Counter(0));
        module.arm(true);
        Self {
            module,
            settings: Self::SETTINGS,
            told: None,
        }
    }

    /// One tick.
    #[inline]
    pub fn tick(&mut self) {
        let told = &mut self.told;
        self.module
            .tick(&self.settings, &mut |event| *told = Some(event));
    }
}

#[cfg(test)]
mod tests {
    use super::Whole;
    use crate::format::Format;
    use crate::report::CALLS;

    #[test]
    fn what_is_counted_is_a_tick_in_which_all_is_well() {
        fn run<R: Format>() {
            let mut whole = Whole::<R, 1, 1>::new(&R::START_1);
            for _ in 0..CALLS {
                whole.tick();
                assert_eq!(whole.told, None);
            }
            assert!(whole.module.contact()[0].to_f64() > 0.0);
        }
        crate::each_format!(run);
    }
}
