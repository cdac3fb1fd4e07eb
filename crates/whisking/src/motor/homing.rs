//! Homing: finding where a whisker is by driving it gently against its retracted stop.
//!
//! First a little forward, then back until it stands still. Without the way forward a whisker
//! that already leans on its stop could not be known from an encoder that is silent.

use serde::{Deserialize, Serialize};

use super::{Duty, Fault, GuardConfig};
use crate::{REST_DEG, Real};

/// How long a whisker must stand still to be at its stop, s: longer than a gear sticks.
const STILL_S: f64 = 0.1;
/// How long homing may take, s: several times the way from stop to stop at a low duty.
const TIME_OUT_S: f64 = 3.0;
/// How far it is driven forward first, degrees: many counts of an encoder, and hardly a
/// movement of the whisker.
const FORWARD_DEG: f64 = 5.0;
/// A rotor that stands against its stop flickers by a count or two.
const FLICKER: u32 = 2;

/// Homing in physical units, of a whisker with its gear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HomingSettings {
    /// Degrees of the whisker a count of the encoder, above 0.
    pub degrees_per_count: f64,
    /// Duty to home with, 0 to 1: below what is hard for the motor's guards, above what its
    /// friction takes.
    pub duty: f64,
    /// Angle θ' of the retracted stop, degrees.
    pub stop_deg: f64,
}

impl HomingSettings {
    /// The constants at `tick_hz` ticks a second.
    pub fn build(&self, tick_hz: f64) -> HomingConfig {
        let ticks = |seconds: f64| libm::round(seconds * tick_hz).max(1.0) as u16;
        let counts = |degrees: f64| libm::round(degrees / self.degrees_per_count);
        HomingConfig {
            duty: Duty::from_f32(self.duty as f32),
            still: ticks(STILL_S),
            time_out: ticks(TIME_OUT_S),
            forward: counts(FORWARD_DEG).max(f64::from(FLICKER) + 1.0) as i32,
            stop: counts(self.stop_deg - REST_DEG) as i32,
        }
    }
}

/// How a whisker is homed. Counts are those of the angle input, protraction counting up.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct HomingConfig {
    /// Duty towards protraction; towards the stop it is the same.
    pub duty: Duty,
    /// Ticks for which it must stand still.
    pub still: u16,
    /// Ticks after which it is given up.
    pub time_out: u16,
    /// Counts that it is driven forward first.
    pub forward: i32,
    /// Counts from rest, θ = 0, to the stop.
    pub stop: i32,
}

/// Which way a whisker is driven while it is homed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Way {
    Forward,
    Back,
}

/// A whisker that is being homed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Homing {
    way: Way,
    /// Ticks since it began.
    ticks: u16,
    /// Ticks for which it has stood still, and where, counts.
    still: u16,
    stands: i32,
    /// Where this way began, counts.
    from: i32,
}

/// What a tick of homing has come to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Homed {
    /// It is to be driven with this duty.
    Not(Duty),
    /// It stands against its stop, and rest, θ = 0, is at this count.
    At(i32),
}

impl Homing {
    /// Begins with the angle input at `counts`.
    pub const fn new(counts: i32) -> Self {
        Self {
            way: Way::Forward,
            ticks: 0,
            still: 0,
            stands: counts,
            from: counts,
        }
    }

    /// One tick, with the angle input at `counts`.
    ///
    /// # Errors
    /// [`Fault::Runaway`] if it moves against the drive or faster than the motor can,
    /// [`Fault::Encoder`] if it moves neither way, [`Fault::Homing`] if it takes too long.
    pub fn step<R: Real>(
        &mut self,
        config: &HomingConfig,
        guards: &GuardConfig<R>,
        counts: i32,
        moved: i32,
    ) -> Result<Homed, Fault> {
        self.ticks = self.ticks.saturating_add(1);
        if self.ticks > config.time_out {
            return Err(Fault::Homing);
        }
        if counts.wrapping_sub(self.stands).unsigned_abs() > FLICKER {
            self.stands = counts;
            self.still = 0;
        } else {
            self.still = self.still.saturating_add(1);
        }
        let way = counts.wrapping_sub(self.from);
        let is_forward = self.way == Way::Forward;
        let is_against = way.unsigned_abs() > guards.against && (way > 0) != is_forward;
        if is_against || moved.unsigned_abs() > guards.speed {
            return Err(Fault::Runaway);
        }
        let is_still = self.still >= config.still;
        match self.way {
            Way::Forward if is_still || way >= config.forward => {
                let ticks = self.ticks;
                *self = Self {
                    way: Way::Back,
                    ticks,
                    ..Self::new(counts)
                };
            }
            Way::Back if is_still && way.saturating_neg() > FLICKER as i32 => {
                return Ok(Homed::At(counts.wrapping_sub(config.stop)));
            }
            Way::Back if is_still => return Err(Fault::Encoder),
            Way::Forward | Way::Back => {}
        }
        Ok(Homed::Not(self.duty(config)))
    }

    /// The duty with which it is driven.
    #[inline]
    pub const fn duty(&self, config: &HomingConfig) -> Duty {
        match self.way {
            Way::Forward => config.duty,
            Way::Back => Duty::from_q15(-config.duty.q15()),
        }
    }
}
