//! Plausibility of motion: whether what is measured fits what is driven.
//!
//! A motor on an [`HBridge`](super::HBridge) gives no sign of motion itself, so the control
//! loop guards it by its encoder. No guard begins again because the direction of the drive
//! changes. Whether a motor moves at all as it is driven is [expected](super::Expected) of a
//! model of it; the limits here are those that need none.

use serde::{Deserialize, Serialize};

use super::model::{Expected, ModelConfig, ModelSettings, Unturned};
use super::{Duty, Fault, StallConfig};
use crate::{DEGREES_PER_UNIT, REST_DEG, Real};

/// How long a following error may be larger than its limit, s: with the tick in which it is
/// found, and one in which the motor is switched off, less than 50 ms.
pub const FOLLOWING_S: f64 = 0.04;
/// How long a motor may be driven hard in all without moving, s: longer than the pause
/// at a whisk's turning point, shorter than a small winding takes to overheat.
pub const STALL_S: f64 = 0.2;
/// Time constant of a small winding, s. Rounded to the nearest power of two in ticks.
pub const WINDING_S: f64 = 8.0;
/// How far a motor may move against a hard drive, degrees: a whisker that is braked from
/// 4,000 degrees a second stops within 31.
const AGAINST_DEG: f64 = 45.0;

/// The acceleration of a motor, of what its model has at full duty, with a margin: one with 30 %
/// more speed and 30 % less time constant has 1.9 times as much.
const FASTER: f64 = 3.0;
/// Counts that an encoder may show in a tick after one without, whatever the motor does: one of a
/// motor that was slower than a count a tick, and two of flicker.
const FLICKERS: f64 = 3.0;

/// Limits in physical units, of a whisker with its gear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GuardSettings {
    /// Degrees of the whisker a count of the encoder, above 0.
    pub degrees_per_count: f64,
    /// Duty above which it is driven hard, 0 to 1.
    pub hard_duty: f64,
    /// How it moves as it is driven; `None`: nothing is expected of it.
    pub model: Option<ModelSettings>,
    /// Largest following error, degrees.
    pub following_deg: f64,
    /// Fastest that the motor can be, degrees a second.
    pub top_speed_deg_s: f64,
    /// Lowest and highest angle θ', degrees.
    pub travel_deg: [f64; 2],
    /// Duty that the winding bears for ever, 0 to 1.
    pub continuous_duty: f64,
}

impl GuardSettings {
    /// Nothing is a fault: for motors that nothing can harm.
    pub const NONE: Self = Self {
        degrees_per_count: 1.0,
        hard_duty: 1.0,
        model: None,
        following_deg: 1e4,
        top_speed_deg_s: f64::MAX,
        travel_deg: [f64::MIN, f64::MAX],
        continuous_duty: 1.0,
    };

    /// The constants at `tick_hz` ticks a second. What its type cannot hold becomes the
    /// nearest that it can.
    pub fn build<R: Real>(&self, tick_hz: f64) -> GuardConfig<R> {
        let ticks = |seconds: f64| libm::round(seconds * tick_hz).max(1.0) as u16;
        let counts = |degrees: f64| libm::ceil(degrees / self.degrees_per_count);
        let [lowest, highest] = self.travel_deg.map(|angle| counts(angle - REST_DEG) as i32);
        let continuous = Duty::from_f32(self.continuous_duty as f32).magnitude();
        GuardConfig {
            stall: StallConfig {
                ticks: ticks(STALL_S),
                threshold: Duty::from_f32(self.hard_duty as f32),
            },
            model: self
                .model
                .and_then(|model| model.build(tick_hz, self.degrees_per_count)),
            error: R::from_f64(self.following_deg / DEGREES_PER_UNIT),
            error_ticks: ticks(FOLLOWING_S),
            against: counts(AGAINST_DEG) as u32,
            speed: counts(self.top_speed_deg_s / tick_hz) as u32,
            leap: self.leap(tick_hz),
            travel: [lowest, highest],
            heat: u32::from(continuous) * u32::from(continuous),
            heat_shift: libm::round(libm::log2(WINDING_S * tick_hz)).clamp(0.0, 31.0) as u8,
        }
    }

    /// Counts to which no motor comes in the tick after one in which it stood: [`FASTER`] a/f²,
    /// with the acceleration a that full duty comes to, at f ticks a second, and [`FLICKERS`].
    fn leap(&self, tick_hz: f64) -> u32 {
        let Some(model) = &self.model else {
            return u32::MAX;
        };
        let acceleration = FASTER * model.speed_deg_s / model.time_constant_s;
        let moved_deg = acceleration / (tick_hz * tick_hz);
        libm::ceil(moved_deg / self.degrees_per_count + FLICKERS) as u32
    }
}

/// What a motor may do. Counts are those of the angle input, protraction counting up.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct GuardConfig<R: Real> {
    /// How long it may be driven hard in all without moving, and what is hard.
    pub stall: StallConfig,
    /// How it moves as it is driven, where something is expected of it.
    pub model: Option<ModelConfig<R>>,
    /// Largest following error, protraction.
    pub error: R,
    /// Ticks in succession for which the following error may be larger.
    pub error_ticks: u16,
    /// Most counts that it may move against a hard drive.
    pub against: u32,
    /// Most counts that it may move in a tick.
    pub speed: u32,
    /// Counts to which no motor comes in the tick after one in which it stood.
    pub leap: u32,
    /// Lowest and highest count from rest.
    pub travel: [i32; 2],
    /// Duty that its winding bears for ever, squared, Q30.
    pub heat: u32,
    /// The winding's time constant is two to this power, ticks.
    pub heat_shift: u8,
}

/// What the guards of a motor remember while it runs. The default is that of a motor that was off.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Guards<R> {
    expected: Expected<R>,
    /// Ticks that it was driven hard forwards and backwards since it last moved.
    still: [u16; 2],
    /// How far it has moved since, counts.
    flicker: i32,
    /// Ticks in succession with too large a following error.
    error_ticks: u16,
    /// Counts that it has moved against a hard drive.
    against: u32,
}

/// A rotor that stands on an edge of its encoder flickers by a count or two.
const FLICKER: u32 = 2;

/// What a tick of a motor is judged by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moved<R> {
    /// The duty that is to be driven, Q24.
    pub duty: i32,
    /// The following error that it comes from, protraction.
    pub error: R,
    /// The smoothed velocity, protraction a tick.
    pub velocity: R,
    /// The angle, counts from rest.
    pub at: i32,
    /// By how many it has moved since the last tick.
    pub counts: i32,
}

impl<R: Real> Guards<R> {
    /// Those of a motor that was off, or followed something else, at a speed in protraction a tick.
    pub fn at_speed(velocity: R) -> Self {
        Self {
            expected: Expected::at_speed(velocity),
            ..Self::default()
        }
    }

    /// Those of a motor that did not move when it ran last: it is tested first.
    pub fn doubtful(config: &GuardConfig<R>, is_forward: bool) -> Self {
        let expected = config.model.as_ref();
        Self {
            expected: expected.map_or_else(Expected::default, |model| {
                Expected::doubtful(model, is_forward)
            }),
            ..Self::default()
        }
    }

    /// Whether the motor is being tested.
    #[inline]
    pub const fn is_tested(&self) -> bool {
        self.expected.is_tested()
    }

    /// The duty of a test of the motor that is under way, Q24, which takes the place of that of
    /// the position control.
    #[inline]
    pub fn test(&self, config: &GuardConfig<R>) -> Option<i32> {
        config
            .model
            .as_ref()
            .and_then(|model| self.expected.test(model))
    }

    /// One tick.
    ///
    /// # Errors
    /// What is not plausible.
    #[inline]
    pub fn check(&mut self, config: &GuardConfig<R>, seen: Moved<R>) -> Result<(), Fault> {
        let Moved {
            duty,
            error,
            velocity,
            at,
            counts: moved,
        } = seen;
        let size = moved.unsigned_abs();
        let [lowest, highest] = config.travel;
        if at < lowest || at > highest {
            return Err(Fault::Travel);
        }
        self.error_ticks = if error.abs() > config.error {
            self.error_ticks.saturating_add(1)
        } else {
            0
        };
        if self.error_ticks > config.error_ticks {
            return Err(Fault::Following);
        }
        if size > config.speed {
            return Err(Fault::Runaway);
        }
        if let Some(model) = &config.model {
            let found = self.expected.step(model, duty, velocity, moved);
            let moves = found.map_err(|unturned| match unturned {
                Unturned::Silent => Fault::Encoder,
                Unturned::Still => Fault::Stall,
                Unturned::Backwards => Fault::Runaway,
            })?;
            if moves {
                self.still = [0; 2];
                self.flicker = 0;
                self.against = 0;
                return Ok(());
            }
        }
        self.check_unmoved(config, Duty::from_q24(duty), moved)
    }

    /// Whether it stands still, or moves the other way, for too long: of what does not move as its
    /// model says, or has none.
    #[inline]
    fn check_unmoved(
        &mut self,
        config: &GuardConfig<R>,
        duty: Duty,
        moved: i32,
    ) -> Result<(), Fault> {
        let is_hard = duty.magnitude() > config.stall.threshold.magnitude();
        if is_hard && moved != 0 {
            self.against = if (moved < 0) == duty.is_forward() {
                self.against.saturating_add(moved.unsigned_abs())
            } else {
                0
            };
        }
        if self.against > config.against {
            return Err(Fault::Runaway);
        }
        self.check_still(config, duty, is_hard, moved)
    }

    #[inline]
    fn check_still(
        &mut self,
        config: &GuardConfig<R>,
        duty: Duty,
        is_hard: bool,
        moved: i32,
    ) -> Result<(), Fault> {
        self.flicker = self.flicker.saturating_add(moved);
        if self.flicker.unsigned_abs() > FLICKER {
            self.flicker = 0;
            self.still = [0; 2];
            return Ok(());
        }
        if is_hard {
            let [forwards, backwards] = &mut self.still;
            let still = if duty.is_forward() {
                forwards
            } else {
                backwards
            };
            *still = still.saturating_add(1);
        }
        match self.still {
            [0, still] | [still, 0] if still >= config.stall.ticks => Err(Fault::Stall),
            [forwards, backwards] if forwards.saturating_add(backwards) >= config.stall.ticks => {
                Err(Fault::Encoder)
            }
            _ => Ok(()),
        }
    }
}

/// How warm a winding is: its duty squared, through a low-pass of its time constant, Q30 (I²t).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Heat(u32);

impl Heat {
    /// One tick with `duty`.
    ///
    /// # Errors
    /// [`Fault::Heat`] above what the winding bears for ever.
    #[inline]
    pub fn check<R: Real>(&mut self, config: &GuardConfig<R>, duty: Duty) -> Result<(), Fault> {
        let duty = u32::from(duty.magnitude());
        // At most 2^30, and so is the state; a state that is not falls to it.
        let shift = u32::from(config.heat_shift & 31);
        self.0 = self.0 - (self.0 >> shift) + ((duty * duty) >> shift);
        if self.0 > config.heat {
            Err(Fault::Heat)
        } else {
            Ok(())
        }
    }
}
