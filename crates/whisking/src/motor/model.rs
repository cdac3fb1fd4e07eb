//! Whether a motor moves as it is driven, by a model of it, and the test of one that seems not to.
//!
//! The model is that of a motor with gear: τ dω/dt = ω₀ (u − f sgn ω) − ω, with the duty u, the
//! speed ω₀ that full duty comes to, the time constant τ and the friction f, as a duty. While the
//! encoder agrees, the speed is the measured one. Where it shows less than
//! [`SHARE`] of what the model expects, what is missing adds up.
//!
//! Too much of it is a doubt and no fault yet: an encoder that stands still and a whisker that its
//! friction or a hand holds look alike. So the motor is *tested*: the drive turns round until the
//! model stands, for a few milliseconds at least. This stops a whisker whose encoder
//! has failed within some degrees, and turns one whose encoder works by as much as an encoder that
//! only jitters does not show. What passes the test has friction, or a load, that is as large as
//! its drive was: from then on the model expects it.
//!
//! With motors whose ω₀ and τ are wrong by 30 % and whose friction is up to four times the
//! model's, nothing is a fault from 0.05 to 14 Hz, and from 0.5 to 12 Hz a whisker whose encoder
//! fails leaves its whisk by less than 20° (`tests/tests/suite/encoder_faults.rs`). An encoder that
//! counts the other way, loses counts or has another scale is not seen by it.

use serde::{Deserialize, Serialize};

use crate::pd::FULL;
use crate::{DEGREES_PER_UNIT, Real};

/// What is expected of a motor at least, of what the model says: play, a weak motor, a supply
/// that sags.
const SHARE: f64 = 0.4;
/// The model's speed, of the motor's: with it one that is 30 % weaker still does what is expected.
const WEAK: f64 = 0.75;
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
const GRACE_S: f64 = 0.04;
/// How fast expected friction falls to what is seen to be enough, s.
const LEARN_S: f64 = 0.5;
/// The most friction that is ever expected, a duty of 0.6, Q24.
const MOST_FRICTION: i32 = 10_066_330;
/// By how much friction is larger than the duty that it has resisted, 0.02, Q24.
const BEYOND: i32 = 335_544;
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
    /// `None` where the model can judge nothing: friction takes all of a test's duty, or the
    /// encoder is coarser than 0.7 degrees.
    pub fn build<R: Real>(&self, tick_hz: f64, degrees_per_count: f64) -> Option<ModelConfig<R>> {
        let duty = TEST_DUTY.min(self.duty_limit);
        let beyond_friction = duty - self.friction_duty;
        if beyond_friction <= 0.0 || degrees_per_count > COARSEST_DEG {
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

/// A test that is under way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Test {
    is_forward: bool,
    /// Ticks since it began, and that in which the drive ends.
    ticks: u16,
    end: u16,
    /// How far it has turned in its direction, counts; the least and the most of that.
    at: i32,
    least: i32,
    most: i32,
}

impl Test {
    const fn new<R: Real>(config: &ModelConfig<R>, is_forward: bool) -> Self {
        Self {
            is_forward,
            ticks: 0,
            end: config.stroke,
            at: 0,
            least: 0,
            most: 0,
        }
    }
}

/// What is expected of a motor while it runs. The default is that of a motor that was off.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Expected<R> {
    /// Protraction a tick.
    speed: R,
    /// What is missing, protraction.
    missing: R,
    /// Duty that friction takes, where more than the configuration says was seen.
    friction: R,
    test: Option<Test>,
    /// Ticks left of a grace.
    grace: u16,
}

/// A motor did not turn in a test.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Unturned {
    /// Not a count was seen.
    pub(super) is_silent: bool,
}

impl<R: Real> Expected<R> {
    /// That of a motor which did not turn when it ran last: it is tested first.
    pub(super) fn doubtful(config: &ModelConfig<R>, is_forward: bool) -> Self {
        Self {
            test: Some(Test::new(config, is_forward)),
            ..Self::default()
        }
    }

    /// Whether a test is under way.
    pub(super) const fn is_tested(&self) -> bool {
        self.test.is_some()
    }

    /// The duty of a test that is under way, Q24, which takes the place of that of the position
    /// control.
    #[inline]
    pub fn test(&self, config: &ModelConfig<R>) -> Option<i32> {
        self.test.map(|test| {
            // First its way, then back until the model stands.
            let is_forward = test.is_forward == (test.ticks <= test.end);
            if is_forward {
                config.test
            } else {
                -config.test
            }
        })
    }

    /// One tick in which a motor that is driven with `duty`, Q24, has `moved` by so many counts,
    /// its `velocity` smoothed, protraction a tick.
    #[inline]
    pub(super) fn step(
        &mut self,
        config: &ModelConfig<R>,
        duty: i32,
        velocity: R,
        moved: i32,
    ) -> Result<(), Unturned> {
        let duty = R::from_q24(duty);
        let friction = config.friction.max(self.friction);
        let agrees = self.missing <= R::ZERO && self.test.is_none();
        if agrees && (self.grace > 0 || !velocity.is_within(config.slow)) {
            self.speed = velocity;
        } else if self.speed == R::ZERO && duty.is_within(friction) && self.test.is_none() {
            // At rest, as it should be.
            self.missing = R::ZERO;
            self.grace = self.grace.saturating_sub(1);
            return Ok(());
        }
        self.speed = config.moved_on(self.speed, duty, friction);
        if self.test.is_some() {
            return self.go_on(config, moved);
        }
        self.expect(config, duty, moved);
        if agrees {
            self.learn(config, duty, velocity, friction);
        }
        Ok(())
    }

    /// Adds up what is missing, and begins a test where it is too much.
    #[inline]
    fn expect(&mut self, config: &ModelConfig<R>, duty: R, moved: i32) {
        let is_forward = self.speed > R::ZERO;
        let shown = R::from_counts(moved, config.shown);
        let shown = if is_forward { shown } else { -shown };
        let missing = self.missing + self.speed.abs() - shown;
        if self.grace > 0 || self.speed == R::ZERO {
            self.grace = self.grace.saturating_sub(1);
            self.missing = R::ZERO;
            return;
        }
        self.missing = missing.clamp(R::ZERO, R::ONE);
        if self.missing > config.doubt {
            self.doubt(config, duty, is_forward);
        }
    }

    /// A whisker that moves has no more friction than drives it.
    #[inline]
    fn learn(&mut self, config: &ModelConfig<R>, duty: R, velocity: R, friction: R) {
        let drives = (duty > R::ZERO) == (velocity > R::ZERO);
        if self.friction > config.friction
            && drives
            && duty.is_within(friction)
            && !velocity.is_within(config.slow)
        {
            self.friction = self.friction - (self.friction - duty.abs()).times(config.learn);
        }
    }

    /// Begins a test if what is missing, and the way to a stop, are too much.
    #[cold]
    fn doubt(&mut self, config: &ModelConfig<R>, duty: R, is_forward: bool) {
        let root = self.speed.times(config.root_stop);
        let root = root.clamp(-R::ONE, R::ONE);
        if self.missing + root * root <= config.missing {
            return;
        }
        let friction = duty.abs() + R::from_q24(BEYOND);
        let friction = friction.clamp(R::ZERO, R::from_q24(MOST_FRICTION));
        self.friction = self.friction.max(friction);
        self.test = Some(Test::new(config, !is_forward));
    }

    /// A tick of a test.
    #[cold]
    fn go_on(&mut self, config: &ModelConfig<R>, moved: i32) -> Result<(), Unturned> {
        let Some(test) = &mut self.test else {
            return Ok(());
        };
        let moved = if test.is_forward {
            moved
        } else {
            moved.wrapping_neg()
        };
        test.at = test.at.saturating_add(moved);
        // What turns back only while it is braked has turned the other way.
        if test.ticks <= test.end {
            test.least = test.least.min(test.at);
        }
        test.most = test.most.max(test.at.saturating_sub(test.least));
        test.ticks = test.ticks.saturating_add(1);
        let turns = self.speed != R::ZERO && (self.speed > R::ZERO) == test.is_forward;
        // The whisker is braked for as long as the model moves on, and again in the end.
        if test.ticks <= test.end {
            if !turns && self.speed != R::ZERO {
                test.end = test.end.max(test.ticks.saturating_add(1));
            }
            return Ok(());
        }
        if turns {
            return Ok(());
        }
        let has_turned = test.most >= config.turned;
        let is_silent = test.most == 0 && test.least == 0;
        self.test = None;
        self.speed = R::ZERO;
        self.missing = R::ZERO;
        self.grace = config.grace;
        if has_turned {
            Ok(())
        } else {
            Err(Unturned { is_silent })
        }
    }
}

impl<R: Real> ModelConfig<R> {
    /// The speed a tick later; a whisker that its friction has stopped stands for that tick.
    #[inline]
    fn moved_on(&self, speed: R, duty: R, friction: R) -> R {
        let sense = if speed == R::ZERO { duty } else { speed };
        let friction = if sense > R::ZERO { friction } else { -friction };
        let beyond = duty - friction;
        if speed == R::ZERO && duty.is_within(friction.abs()) {
            return R::ZERO;
        }
        let next = speed + (beyond.times(self.speed) - speed).times(self.rate);
        let has_turned = speed != R::ZERO && (next > R::ZERO) != (speed > R::ZERO);
        if has_turned { R::ZERO } else { next }
    }
}
