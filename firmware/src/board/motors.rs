//! The motors that a scene can have: the same on every board.

use firmware::{Driver, Part};
use whisking::motor::{Duty, Fault, HBridge, MotorDriver, SixStep, SixStepConfig, StallConfig};

use super::gpio::{Pin, PinName};
use super::pin_config::{Mode, PinConfig};
use super::pwm::Channel;
use super::wiring::{ENABLES, HALLS, Output, PWMS, Side};
use crate::here::{PWM_FUNCTION, free_hall_pins};

const PWM_PIN: PinConfig = PinConfig::new(Mode::AlternateOutput(PWM_FUNCTION));

type Brushed = HBridge<Channel, Pin>;

/// A brushless motor with Hall sensors on three half-bridges (L6230).
type Brushless = SixStep<(Channel, Channel, Channel), (Pin, Pin, Pin), (Pin, Pin, Pin)>;

/// A motor of either kind. Of one that an image is built without there is none, and no code.
#[allow(
    clippy::large_enum_variant,
    reason = "memory has room for it, and nothing else to put it in"
)]
pub(crate) enum Motor {
    Brushed(Brushed),
    Brushless(Brushless),
}

#[derive(Clone, Copy)]
pub(crate) struct MotorStart {
    pub(crate) driver: Driver,
    /// What a stall is to the power stage of a brushless one.
    pub(crate) stall: StallConfig,
    /// Counts of the PWM in a period.
    pub(crate) pwm_counts: u16,
}

impl Motor {
    /// A motor of `side` that is off, once the PWM was started; `None` of a kind that is not built.
    pub(crate) fn start(side: &Side, with: &MotorStart) -> Option<Self> {
        match with.driver {
            Driver::SixStep if Part::SixStep.is_built() => Some(Self::Brushless(brushless(with))),
            Driver::HBridge if Part::HBridge.is_built() => Some(Self::Brushed(brushed(side, with))),
            _ => None,
        }
    }
}

fn brushed(side: &Side, with: &MotorStart) -> Brushed {
    let bridge = &side.bridge;
    let direction = Pin::new(bridge.direction, PinConfig::OUTPUT);
    let channel = Channel::of(bridge.output, with.pwm_counts);
    let motor = HBridge::new(channel, direction).with_buffered_pwm();
    Pin::new(bridge.pwm, PWM_PIN);
    motor
}

/// A brushless motor that is off. It takes every output of the timer, so there is one.
fn brushless(with: &MotorStart) -> Brushless {
    let config = SixStepConfig {
        stall: with.stall,
        ..SixStepConfig::DEFAULT
    };
    let pins = |names: [PinName; 3], config| {
        let [a, b, c] = names.map(|name| Pin::new(name, config));
        (a, b, c)
    };
    free_hall_pins();
    let enables = pins(ENABLES, PinConfig::OUTPUT);
    let halls = pins(HALLS, PinConfig::INPUT.pulled_up());
    let outputs = [Output::One, Output::Two, Output::Three];
    let [a, b, c] = outputs.map(|output| Channel::of(output, with.pwm_counts));
    let motor = SixStep::new((a, b, c), enables, halls, config).with_buffered_pwm();
    pins(PWMS, PWM_PIN);
    motor
}

// Apart, so that a tick of a brushed one keeps its registers.
#[inline(never)]
fn commutate(motor: &mut Brushless, duty: Duty) -> Result<(), Fault> {
    motor.drive(duty)
}

impl MotorDriver for Motor {
    #[inline]
    fn drive(&mut self, duty: Duty) -> Result<(), Fault> {
        match self {
            Self::Brushless(motor) if Part::SixStep.is_built() => commutate(motor, duty),
            Self::Brushed(motor) if Part::HBridge.is_built() => motor.drive(duty),
            // Of a kind that is not built there is none.
            _ => Ok(()),
        }
    }

    #[inline]
    fn off(&mut self) {
        match self {
            Self::Brushless(motor) if Part::SixStep.is_built() => motor.off(),
            Self::Brushed(motor) if Part::HBridge.is_built() => motor.off(),
            _ => {}
        }
    }

    fn clear(&mut self) {
        match self {
            Self::Brushless(motor) if Part::SixStep.is_built() => motor.clear(),
            Self::Brushed(motor) if Part::HBridge.is_built() => motor.clear(),
            _ => {}
        }
    }
}
