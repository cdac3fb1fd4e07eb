//! Homing: finding where a whisker is by driving it gently against its retracted stop.
//!
//! First a little forward, then back until it stands still. Without the way forward a whisker
//! that already leans on its stop could not be known from an encoder that is silent.
//!
//! What it met may be a hand. Where home is known, the stop must be where it was. Where it is
//! not, the whisker goes through its whole range once: a hand far from the stop leaves less of it.

use serde::{Deserialize, Serialize};

use super::{Duty, Fault, GuardConfig};
use crate::{REST_DEG, Real};

/// How long a whisker must stand still to be at its stop, s: longer than a gear sticks.
const STILL_S: f64 = 0.1;
/// The longest that it may have to, where counts are so coarse that the next ones take longer: a
/// sixth of what its ways may take.
const STILL_MOST_S: f64 = 0.5;
/// How long each of the ways of homing may take, s: several times the way from stop to stop at a
/// low duty.
const TIME_OUT_S: f64 = 3.0;
/// How far it is driven forward first, degrees: many counts of an encoder, and hardly a
/// movement of the whisker.
const FORWARD_DEG: f64 = 5.0;
/// How far from its place a stop may be found again, degrees: it is met at the same speed each
/// time, so that gear and whisker give way as before.
const TOLERANCE_DEG: f64 = 1.0;
/// How far from its angle in a scene the far stop may be found, degrees.
const FAR_DEG: f64 = 3.0;
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
    /// Highest angle θ' that it is driven to.
    pub max_deg: f64,
    /// Angle θ' of the other stop, degrees, where it is known.
    pub far_stop_deg: Option<f64>,
    /// How often home is looked for again, s.
    pub every_s: f64,
    /// Contact π from which the whisker touches something, 0 to 1.
    pub calm: f64,
}

impl HomingSettings {
    /// How slow a whisker can be that comes through its range in time, degrees/s; of no range 1.
    fn slowest_deg_s(&self) -> f64 {
        let end = self.far_stop_deg.unwrap_or(self.max_deg);
        ((end - self.stop_deg) / TIME_OUT_S).max(1.0)
    }

    /// The most degrees a count by which one that moves so can be told from one that stands.
    pub fn coarsest_deg(&self) -> f64 {
        STILL_MOST_S * self.slowest_deg_s() / f64::from(FLICKER + 1)
    }

    /// How long it must stand still: as long as the slowest one needs for more counts than those
    /// by which one that stands flickers.
    fn still_s(&self) -> f64 {
        let degrees = f64::from(FLICKER + 1) * self.degrees_per_count;
        (degrees / self.slowest_deg_s()).clamp(STILL_S, STILL_MOST_S)
    }

    /// The constants at `tick_hz` ticks a second.
    pub fn build(&self, tick_hz: f64) -> HomingConfig {
        let ticks = |seconds: f64| libm::round(seconds * tick_hz).max(1.0) as u16;
        let counts = |degrees: f64| libm::round(degrees / self.degrees_per_count);
        let within = |degrees: f64| counts(degrees).max(f64::from(FLICKER)) as u32;
        HomingConfig {
            duty: Duty::from_f32(self.duty as f32),
            still: ticks(self.still_s()),
            time_out: ticks(TIME_OUT_S),
            forward: counts(FORWARD_DEG).max(f64::from(FLICKER) + 1.0) as i32,
            stop: counts(self.stop_deg - REST_DEG) as i32,
            range: counts(self.far_stop_deg.unwrap_or(self.max_deg) - self.stop_deg) as i32,
            far_within: self.far_stop_deg.map(|_| within(FAR_DEG)),
            tolerance: within(TOLERANCE_DEG),
            every: libm::round(self.every_s * tick_hz).max(1.0) as u32,
            calm: libm::round(self.calm * f64::from(1 << 24)) as i32,
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
    /// Counts from the stop to the other one, or to the highest angle.
    pub range: i32,
    /// Most counts by which the other stop may be elsewhere, if it is known.
    pub far_within: Option<u32>,
    /// Most counts by which the stop may be elsewhere than before.
    pub tolerance: u32,
    /// Ticks after which home is looked for again.
    pub every: u32,
    /// Contact π from which the whisker touches something, Q24: then it is not looked for.
    pub calm: i32,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Way {
    Forward,
    Back,
    /// From the stop through its range.
    Through,
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
    /// Home where it was found last, if it is known, counts.
    known: Option<i32>,
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
    /// Begins with the angle input at `counts`, and at which of them rest is if it is known.
    pub const fn new(counts: i32, known: Option<i32>) -> Self {
        Self {
            way: Way::Forward,
            ticks: 0,
            still: 0,
            stands: counts,
            from: counts,
            known,
        }
    }

    const fn turn(&mut self, way: Way, counts: i32) {
        let ticks = match way {
            Way::Through => 0,
            Way::Forward | Way::Back => self.ticks,
        };
        *self = Self {
            way,
            ticks,
            ..Self::new(counts, self.known)
        };
    }

    /// One tick, with the angle input at `counts`.
    ///
    /// # Errors
    /// [`Fault::Runaway`] if it moves against the drive or faster than the motor can,
    /// [`Fault::Encoder`] if it moves neither way, [`Fault::Homing`] if it takes too long or its
    /// range has another length, [`Fault::LostCounts`] if the stop is elsewhere than it was.
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
        let is_forward = self.way != Way::Back;
        let is_against = way.unsigned_abs() > guards.against && (way > 0) != is_forward;
        if is_against || moved.unsigned_abs() > guards.speed {
            return Err(Fault::Runaway);
        }
        let is_still = self.still >= config.still;
        match self.way {
            Way::Forward if is_still || way >= config.forward => {
                self.turn(Way::Back, counts);
            }
            Way::Back if is_still && way.saturating_neg() > FLICKER as i32 => {
                let home = counts.wrapping_sub(config.stop);
                match self.known {
                    Some(known) if home.wrapping_sub(known).unsigned_abs() > config.tolerance => {
                        return Err(Fault::LostCounts);
                    }
                    Some(_) => return Ok(Homed::At(home)),
                    None => self.turn(Way::Through, counts),
                }
            }
            Way::Back if is_still => return Err(Fault::Encoder),
            Way::Through => {
                let left = config.range.saturating_sub(way);
                let is_there = match config.far_within {
                    Some(within) => is_still && left.unsigned_abs() <= within,
                    None => left <= 0,
                };
                if is_there {
                    return Ok(Homed::At(self.from.wrapping_sub(config.stop)));
                }
                let most = config.far_within.unwrap_or(0);
                if is_still || left < 0 && left.unsigned_abs() > most {
                    return Err(Fault::Homing);
                }
            }
            Way::Forward | Way::Back => {}
        }
        Ok(Homed::Not(self.duty(config)))
    }

    /// The duty with which it is driven.
    #[inline]
    pub const fn duty(&self, config: &HomingConfig) -> Duty {
        match self.way {
            Way::Forward | Way::Through => config.duty,
            Way::Back => Duty::from_q15(-config.duty.q15()),
        }
    }
}
