//! Motor drivers: a signed drive in, switched pins out, faults that keep the motor off.
//!
//! Two power stages behind one trait, [`MotorDriver`]: a brushed motor on an H-bridge ([`HBridge`])
//! and a three-phase brushless motor commutated from its Hall sensors ([`SixStep`]). The BIOTACT
//! module used the latter: a Faulhaber 1307BH with an 11:1 gearbox and a custom three-phase bridge
//! (Sullivan et al. 2011, section II.C). Nothing here names a chip: pins and timers are
//! embedded-hal 1.0 traits.
//!
//! Glossary:
//!
//! - *protraction*: the whisker sweeping forward; the sign of a positive
//!   [`Duty`].
//! - *duty*: the fraction of the supply voltage applied to the motor, signed.
//! - *off*: no phase is driven. The H-bridge is at a PWM of zero (most
//!   bridges brake there); the three-phase stage has all phases floating.
//! - *tick*: one call of `drive`, 500 µs apart at BIOTACT's 2 kHz.
//! - *sector*: a sixth of an electrical turn, 60°, as given by three Hall
//!   sensors.
//! - *lead*: the electrical angle from the rotor's magnet to the driven field;
//!   torque is proportional to its sine.
//! - *stall*: driven hard without moving, which overheats windings.
//! - *buffered PWM*: a timer whose compare value takes effect only at the next
//!   PWM period ("preload"), so that a pin written later changes earlier.
//!
//! A fault switches the motor off and holds it there until
//! [`MotorDriver::clear`]. Every fault has a stable number, [`Fault::code`].

mod commutation;
mod duty;
mod guard;
mod hall;
mod hbridge;
mod homing;
mod model;
mod six_step;
mod stall;

use core::fmt;

use embedded_hal::pwm::SetDutyCycle;
use serde::{Deserialize, Serialize};

pub use commutation::Sector;
pub use duty::Duty;
pub use guard::{FOLLOWING_S, GuardConfig, GuardSettings, Guards, Heat, Moved, STALL_S, WINDING_S};
pub use hall::HallTracker;
pub use hbridge::HBridge;
pub use homing::{Homed, Homing, HomingConfig, HomingSettings};
pub use model::{Expected, MOST_FRICTION, ModelConfig, ModelSettings};
pub use six_step::{SixStep, SixStepConfig};
pub use stall::{StallConfig, StallGuard};

/// The stage that turns a duty into winding currents.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Driver {
    /// One H-bridge: a brushed motor.
    HBridge,
    /// Three half-bridges commutated in six steps: a brushless motor.
    SixStep,
}

/// What the control loop needs of a motor.
///
/// Call [`drive`](Self::drive) once per tick; an error means that the motor has
/// been switched off and stays off until [`clear`](Self::clear).
pub trait MotorDriver {
    /// Drives with the given duty until the next call.
    ///
    /// While a fault stands, the outputs are switched off again and the same fault is returned.
    ///
    /// # Errors
    /// The fault that stands, or the one just found.
    fn drive(&mut self, duty: Duty) -> Result<(), Fault>;

    /// Switches the motor off.
    ///
    /// Always returns, and tries every output even when one fails; a failure
    /// becomes a fault, which the next [`drive`](Self::drive) returns.
    fn off(&mut self);

    /// Clears the fault. The motor stays off until the next
    /// [`drive`](Self::drive).
    fn clear(&mut self);
}

/// Sets a PWM to the magnitude of a duty, scaled to its largest.
#[inline]
fn set_pwm(pwm: &mut impl SetDutyCycle, duty: Duty) -> Result<(), Fault> {
    let counts = duty.scaled_to(pwm.max_duty_cycle());
    pwm.set_duty_cycle(counts).map_err(|_| Fault::Pwm)
}

#[inline]
fn zero_pwm(pwm: &mut impl SetDutyCycle) -> Result<(), Fault> {
    pwm.set_duty_cycle_fully_off().map_err(|_| Fault::Pwm)
}

/// Why a motor was switched off.
///
/// Numbers (see [`Fault::code`]) never change meaning; 0 is reserved for "none".
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Fault {
    /// 1: a pin could not be read or written.
    Pin,
    /// 2: a PWM channel could not be set.
    Pwm,
    /// 3 for code 0, 4 for any other: the Hall sensors gave a code that no rotor angle has.
    InvalidHall(u8),
    /// 5: the rotor skipped Hall sectors in too many ticks in succession.
    SkippedSector,
    /// 6: does not move as it is driven: in a test of its motion, or above the stall threshold
    /// for too long.
    Stall,
    /// 7: the angle was too far from its setpoint for too long.
    Following,
    /// 8: moves against the drive, or faster than the motor can.
    Runaway,
    /// 9: the same, and not a count was seen.
    Encoder,
    /// 10: beyond the ends of its travel.
    Travel,
    /// 11: driven with more than its winding bears (I²t of the duty).
    Heat,
    /// 12: its retracted stop was not found in time. Likely cause: the whisker turns freely,
    /// or too slowly.
    Homing,
    /// 13: the encoder has lost counts: it came back from standing faster than any motor turns,
    /// twice, or its retracted stop was found elsewhere than before.
    LostCounts,
}

impl Fault {
    /// The stable number of the fault, 1 to 13, for telemetry.
    pub const fn code(self) -> u8 {
        match self {
            Self::Pin => 1,
            Self::Pwm => 2,
            Self::InvalidHall(0) => 3,
            Self::InvalidHall(_) => 4,
            Self::SkippedSector => 5,
            Self::Stall => 6,
            Self::Following => 7,
            Self::Runaway => 8,
            Self::Encoder => 9,
            Self::Travel => 10,
            Self::Heat => 11,
            Self::Homing => 12,
            Self::LostCounts => 13,
        }
    }

    /// The fault with a number, for readers of telemetry; `None` for a number not in use. 4 becomes
    /// [`Fault::InvalidHall`]`(7)`, the only code it is given for in practice.
    pub const fn from_code(code: u8) -> Option<Self> {
        match code {
            1 => Some(Self::Pin),
            2 => Some(Self::Pwm),
            3 => Some(Self::InvalidHall(0)),
            4 => Some(Self::InvalidHall(7)),
            5 => Some(Self::SkippedSector),
            6 => Some(Self::Stall),
            7 => Some(Self::Following),
            8 => Some(Self::Runaway),
            9 => Some(Self::Encoder),
            10 => Some(Self::Travel),
            11 => Some(Self::Heat),
            12 => Some(Self::Homing),
            13 => Some(Self::LostCounts),
            _ => None,
        }
    }
}

/// Number and name; texts for people are the business of whoever logs.
impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "motor fault {}: {self:?}", self.code())
    }
}

impl core::error::Error for Fault {}
