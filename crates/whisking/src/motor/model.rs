//! Whether a motor moves as it is driven, by a model of it, and the test of one that seems not to.
//!
//! The model is that of a motor with gear: τ dω/dt = ω₀ (u − f sgn ω) − ω, with the duty u, the
//! speed ω₀ that full duty comes to, the time constant τ and the friction f, as a duty. While the
//! encoder agrees, the speed is the measured one. Where it shows less than
//! [`SHARE`] of what the model expects, what is missing adds up; and where it shows a whisker that
//! moves against its drive and does not lose speed by it, the model goes on without the encoder.
//!
//! Too much of it is a doubt and no fault yet: an encoder that stands still and a whisker that its
//! friction or a hand holds look alike. So the motor is *tested*: the drive turns round until the
//! model stands, and then for a few milliseconds. This stops a whisker whose encoder
//! has failed within some degrees, and turns one whose encoder works by as much as an encoder that
//! only jitters does not show, and the way it is driven, as one that counts the other way does not.
//! What passes the test has friction, or a load, that is as large as
//! its drive was: from then on the model expects it, but not that it helps to stop the whisker.
//!
//! With motors whose ω₀ and τ are wrong by 30 %, whose friction is up to four times the
//! model's and whose gear has play, no motor is lost from 0.05 to 14 Hz, and from 0.5 to 12 Hz a
//! whisker whose encoder stands still, jitters or counts the other way
//! leaves its whisk by less than 20° (`tests/tests/suite/encoder_faults.rs`). An encoder that
//! loses counts or has another scale is not seen by it.

mod expected;

use serde::{Deserialize, Serialize};

pub use expected::Expected;
pub(super) use expected::Unturned;

use crate::pd::FULL;
use crate::{DEGREES_PER_UNIT, Real};

/// What is expected of a motor at least, of what the model says: play, a weak motor, a supply
/// that sags.
const SHARE: f64 = 0.4;
/// The model's speed, of the motor's: with it one that is 30 % weaker still does what is expected.
const WEAK: f64 = 0.75;
/// What a drive takes from the speed of a whisker that moves against it, at least, of what the
/// model says: less than [`WEAK`], as a hand may push.
const BRAKED: f64 = 0.375;
/// How much may be missing, degrees, with the way in which the whisker can be stopped: some steps
/// of friction that is a little larger than expected.
const MISSING_DEG: f64 = 3.0;
/// What must be missing at least before the way to a stop counts, degrees.
const DOUBT_DEG: f64 = 1.0;
/// Slower than this a whisker is at rest, degrees a second: an encoder that jitters by two counts
/// shows as much.
const SLOW_DEG_S: f64 = 30.0;
/// The duty of a test, at most: strong against friction, so that a test is short.
const TEST_DUTY: f64 = 0.8;
/// The share of the largest duty of a test that friction may take.
pub const MOST_FRICTION: f64 = 0.9;
/// What a test must turn a whisker by, degrees, and counts of a coarse encoder: more than one
/// that jitters by three counts (of 0.064 degrees) shows.
const TURNED_DEG: f64 = 0.5;
const TURNED_COUNTS: f64 = 3.0;
/// By how much more a test turns a motor as the model has it: four times its friction and 30 %
/// less torque leave a third.
const MARGIN: f64 = 3.0;
/// How long a test may wait for its duty, which changes no faster than others, s.
const MOST_RISE_S: f64 = 0.01;
/// How long nothing is expected after a test, s: it takes as long to follow again.
const GRACE_S: f64 = 0.01;
/// How fast expected friction falls to what is seen to be enough, s.
const LEARN_S: f64 = 0.5;
/// The coarsest encoder that a test can judge, degrees a count: its test turns a motor by 6°.
const COARSEST_DEG: f64 = 0.7;

/// A motor in physical units, with its gear, at the whisker.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModelSettings {
    /// Speed at full duty, degrees a second, above 0.
    pub speed_deg_s: f64,
    /// Time constant τ, s, above 0.
    pub time_constant_s: f64,
    /// Duty that friction takes, at least 0.
    pub friction_duty: f64,
    /// Largest duty, above 0 and at most 1.
    pub duty_limit: f64,
    /// Largest change of the duty per second, above 0.
    pub slew_per_s: f64,
}

impl ModelSettings {
    /// The constants at `tick_hz` ticks a second with an encoder of so many degrees a count.
    /// `None` where the model can judge nothing: friction takes nine tenths of a test's duty or
    /// more, or the encoder is coarser than 0.7 degrees.
    pub fn build<R: Real>(&self, tick_hz: f64, degrees_per_count: f64) -> Option<ModelConfig<R>> {
        let duty = TEST_DUTY.min(self.duty_limit);
        let beyond_friction = duty - self.friction_duty;
        if self.friction_duty >= MOST_FRICTION * duty || degrees_per_count > COARSEST_DEG {
            return None;
        }
        let ticks = |seconds: f64| libm::ceil(seconds * tick_hz).clamp(1.0, 65_535.0) as u16;
        let unit = |degrees: f64| R::from_f64(degrees / DEGREES_PER_UNIT);
        let acceleration = self.speed_deg_s / self.time_constant_s;
        let turned = TURNED_DEG.max(TURNED_COUNTS * degrees_per_count);
        let stroke_s = libm::sqrt(2.0 * MARGIN * turned / (acceleration * beyond_friction));
        let stroke_s = stroke_s + (duty / self.slew_per_s / 2.0).min(MOST_RISE_S);
        // Half of the speed a tick, squared, by the deceleration a tick.
        let stop = tick_hz * tick_hz / (2.0 * acceleration * duty * WEAK) * DEGREES_PER_UNIT;
        Some(ModelConfig {
            speed: R::coefficient(WEAK * self.speed_deg_s / tick_hz / DEGREES_PER_UNIT),
            rate: R::coefficient((1.0 / (self.time_constant_s * tick_hz)).min(1.0)),
            braked: R::coefficient(BRAKED * acceleration / (tick_hz * tick_hz) / DEGREES_PER_UNIT),
            shown: R::coefficient(degrees_per_count / DEGREES_PER_UNIT / SHARE),
            root_stop: R::coefficient(libm::sqrt(stop)),
            friction: R::from_f64(self.friction_duty),
            slow: unit(SLOW_DEG_S / tick_hz),
            doubt: unit(DOUBT_DEG),
            missing: unit(MISSING_DEG),
            test: (duty * FULL) as i32,
            stroke: ticks(stroke_s),
            turned: libm::ceil(turned / degrees_per_count) as i32,
            grace: ticks(GRACE_S),
            learn: R::coefficient((1.0 / (LEARN_S * tick_hz)).min(1.0)),
        })
    }
}

/// A motor per tick and per unit of protraction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct ModelConfig<R: Real> {
    /// Protraction a tick that full duty comes to.
    pub speed: R::Coefficient,
    /// A tick, of the time constant.
    pub rate: R::Coefficient,
    /// Protraction a tick that full duty takes from a whisker that moves against it, in a tick,
    /// at least.
    pub braked: R::Coefficient,
    /// Protraction that the model may expect for each count that is measured.
    pub shown: R::Coefficient,
    /// The square root of the way in which the test stops a speed of one, protraction.
    pub root_stop: R::Coefficient,
    /// Duty that friction takes at least.
    pub friction: R,
    /// Protraction a tick of a whisker that moves.
    pub slow: R,
    /// What is missing at least where there is a doubt, protraction.
    pub doubt: R,
    /// What may be missing, protraction.
    pub missing: R,
    /// Duty of a test, Q24.
    pub test: i32,
    /// Ticks of a test at least.
    pub stroke: u16,
    /// Counts that it must turn the motor by.
    pub turned: i32,
    /// Ticks after it in which nothing is expected.
    pub grace: u16,
    /// How fast expected friction falls.
    pub learn: R::Coefficient,
}

impl<R: Real> ModelConfig<R> {
    /// The speed a tick later; a whisker that its friction has stopped stands for that tick.
    /// `resists` is the duty that it resists, of which friction alone helps to stop it: the rest
    /// may be a hand.
    #[inline]
    fn moved_on(&self, speed: R, duty: R, resists: R) -> R {
        if speed == R::ZERO && duty.is_within(resists) {
            return R::ZERO;
        }
        let sense = if speed == R::ZERO { duty } else { speed };
        let is_driven = (duty > R::ZERO) == (sense > R::ZERO);
        let friction = if is_driven { resists } else { self.friction };
        let beyond = if sense > R::ZERO {
            duty - friction
        } else {
            duty + friction
        };
        let next = speed + (beyond.times(self.speed) - speed).times(self.rate);
        let has_turned = speed != R::ZERO && (next > R::ZERO) != (speed > R::ZERO);
        if has_turned { R::ZERO } else { next }
    }
}
