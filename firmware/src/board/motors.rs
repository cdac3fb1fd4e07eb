//! The motors that a scene can have: the same on every board.

use core::sync::atomic::{AtomicBool, Ordering};

use firmware::{Driver, Part};
use whisking::motor::{Duty, Fault, HBridge, MotorDriver, SixStep, SixStepConfig, StallConfig};

use super::gpio::{Pin, PinName};
use super::integrity::Span;
use super::outputs;
use super::pin_config::{Mode, PinConfig};
use super::pwm::Channel;
use super::wiring::{ENABLES, HALLS, PWMS, Side};
use crate::here::{PWM_FUNCTION, free_hall_pins};

const PWM_PIN: PinConfig = PinConfig::new(Mode::AlternateOutput(PWM_FUNCTION));

type Brushed = HBridge<Channel, Pin>;

/// A brushless motor with Hall sensors on three half-bridges (L6230).
type Brushless = SixStep<Channel, Pin, Pin>;

/// A motor of either kind. Of one that an image is built without there is none, and no code.
#[allow(
    clippy::large_enum_variant,
    reason = "memory has room for it, and nothing else to put it in"
)]
pub(crate) enum Motor {
    Brushed(Brushed),
    Brushless(Brushless),
}

/// Whether motors are brushless: none must be driven, nor taken for off, as if it were the other.
static IS_BRUSHLESS: AtomicBool = AtomicBool::new(false);

#[inline]
fn is_brushless() -> bool {
    let has_both = Part::HBridge.is_built() && Part::SixStep.is_built();
    if has_both {
        IS_BRUSHLESS.load(Ordering::Relaxed)
    } else {
        Part::SixStep.is_built()
    }
}

/// Whether a motor was found to be of another kind: memory has lost a bit. [Idle](super::integrity)
/// reports it, as no interrupt may end the program.
static IS_LOST: AtomicBool = AtomicBool::new(false);

pub(crate) fn is_lost() -> bool {
    IS_LOST.load(Ordering::Relaxed)
}

#[cold]
#[inline(never)]
fn lose() -> Fault {
    outputs::off();
    IS_LOST.store(true, Ordering::Relaxed);
    Fault::Pwm
}

#[derive(Clone, Copy)]
pub(crate) struct MotorStart {
    pub(crate) driver: Driver,
    /// What a stall is to the power stage of a brushless one.
    pub(crate) stall: StallConfig,
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

    /// Where its PWMs are, which nothing writes: switched off would be what that leads to.
    pub(crate) fn constants(&self) -> Span {
        match self {
            Self::Brushless(motor) if Part::SixStep.is_built() => Span::of(motor.pwms()),
            Self::Brushed(motor) if Part::HBridge.is_built() => Span::of(motor.pwm()),
            _ => Span::NONE,
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
    IS_BRUSHLESS.store(true, Ordering::Relaxed);
    let config = SixStepConfig {
        stall: with.stall,
        ..SixStepConfig::DEFAULT
    };
    let pins = |names: [PinName; 3], config| names.map(|name| Pin::new(name, config));
    free_hall_pins();
    let enables = pins(ENABLES, PinConfig::OUTPUT);
    let halls = pins(HALLS, PinConfig::INPUT.pulled_up());
    let channels = [0, 1, 2].map(|output| Channel::of(output, with.pwm_counts));
    let motor = SixStep::new(channels, enables, halls, config).with_buffered_pwm();
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
            Self::Brushless(motor) if is_brushless() => commutate(motor, duty),
            Self::Brushed(motor) if !is_brushless() => motor.drive(duty),
            _ => Err(lose()),
        }
    }

    #[inline]
    fn off(&mut self) {
        match self {
            Self::Brushless(motor) if is_brushless() => motor.off(),
            Self::Brushed(motor) if !is_brushless() => motor.off(),
            _ => {
                lose();
            }
        }
    }

    fn clear(&mut self) {
        match self {
            Self::Brushless(motor) if is_brushless() => motor.clear(),
            Self::Brushed(motor) if !is_brushless() => motor.clear(),
            _ => {
                lose();
            }
        }
    }
}
