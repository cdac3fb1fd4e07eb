//! What is expected of a motor while it runs, and the test of one that does something else.

use super::ModelConfig;
use crate::Real;

/// The most friction that is ever expected, a duty of 0.6, Q24.
const MOST_FRICTION: i32 = 10_066_330;
/// By how much friction is larger than the duty that it has resisted, 0.02, Q24.
const BEYOND: i32 = 335_544;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Test {
    is_forward: bool,
    /// Ticks since it began, and that in which the drive ends.
    ticks: u16,
    end: u16,
    /// How far it has turned in its direction since the model stood, counts, and the least of
    /// that, until the drive ends.
    at: i32,
    least: i32,
    /// Counts that were seen in all, either way.
    seen: u32,
    /// It was seen to go on its old way ever since, as a weak motor does for longer than its
    /// model, and no encoder that stands or counts the other way.
    is_old: bool,
    /// It moved in its direction last, as what only comes to rest does not.
    follows: bool,
}

impl Test {
    const fn new<R: Real>(config: &ModelConfig<R>, is_forward: bool) -> Self {
        Self {
            is_forward,
            ticks: 0,
            end: config.stroke,
            at: 0,
            least: 0,
            seen: 0,
            is_old: true,
            follows: false,
        }
    }
}

/// What a motor does, as far as its model goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Phase {
    /// What is driven.
    #[default]
    Free,
    Test(Test),
    /// It has passed a test, and so many ticks are left in which nothing is expected of it.
    Grace(u16),
}

/// What is expected of a motor while it runs. The default is that of a motor that was off.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Expected<R> {
    phase: Phase,
    /// Protraction a tick.
    speed: R,
    /// What is missing, protraction.
    missing: R,
    /// Duty that friction takes, where more than the configuration says was seen.
    friction: R,
}

/// What a motor did in a test in place of turning as it was driven.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::motor) enum Unturned {
    /// Not a count was seen.
    Silent,
    Still,
    Backwards,
}

impl<R: Real> Expected<R> {
    pub(in crate::motor) fn at_speed(speed: R) -> Self {
        Self {
            speed,
            ..Self::default()
        }
    }

    /// That of a motor which did not turn when it ran last: it is tested first.
    pub(in crate::motor) fn doubtful(config: &ModelConfig<R>, is_forward: bool) -> Self {
        Self {
            phase: Phase::Test(Test::new(config, is_forward)),
            ..Self::default()
        }
    }

    pub(in crate::motor) const fn is_tested(&self) -> bool {
        matches!(self.phase, Phase::Test(_))
    }

    /// The duty of a test that is under way, Q24, which takes the place of that of the position
    /// control.
    #[inline]
    pub const fn test(&self, config: &ModelConfig<R>) -> Option<i32> {
        let Phase::Test(test) = &self.phase else {
            return None;
        };
        // First its way, then back until the model stands.
        let is_forward = test.is_forward == (test.ticks <= test.end);
        Some(if is_forward {
            config.test
        } else {
            -config.test
        })
    }

    /// One tick in which a motor that is driven with `duty`, Q24, has `moved` by so many counts,
    /// its `velocity` smoothed, protraction a tick. Whether it moves as it is driven.
    #[inline]
    pub(in crate::motor) fn step(
        &mut self,
        config: &ModelConfig<R>,
        duty: i32,
        velocity: R,
        moved: i32,
    ) -> Result<bool, Unturned> {
        let duty = R::from_q24(duty);
        match self.phase {
            Phase::Free => {
                let shown = R::from_counts(moved, config.shown);
                let agrees = self.agrees(config, duty, velocity, shown);
                if agrees {
                    self.speed = velocity;
                    if self.friction > config.friction {
                        self.learn(config, duty, velocity);
                    }
                } else {
                    self.expect(config, duty, shown);
                }
                Ok(agrees)
            }
            Phase::Test(_) => {
                self.go_on(config, duty, velocity, moved)?;
                Ok(false)
            }
            Phase::Grace(left) => {
                self.speed = velocity;
                self.phase = match left.checked_sub(1) {
                    Some(left) => Phase::Grace(left),
                    None => Phase::Free,
                };
                Ok(false)
            }
        }
    }

    /// Whether the whisker moves, as the encoder and the drive have it.
    #[inline]
    fn agrees(&self, config: &ModelConfig<R>, duty: R, velocity: R, shown: R) -> bool {
        // Against its drive it loses speed, and all the more if friction helps.
        let least = || self.speed + duty.times(config.braked);
        if self.missing > R::ZERO || velocity.is_within(config.slow) {
            false
        } else if velocity > R::ZERO {
            shown >= velocity && (duty >= R::ZERO || velocity <= least())
        } else {
            shown <= velocity && (duty <= R::ZERO || velocity >= least())
        }
    }

    /// Moves the model on, adds up what is missing, and begins a test where it is too much.
    #[inline]
    fn expect(&mut self, config: &ModelConfig<R>, duty: R, shown: R) {
        let friction = config.friction.max(self.friction);
        self.speed = config.moved_on(self.speed, duty, friction);
        if self.speed == R::ZERO {
            self.missing = R::ZERO;
            return;
        }
        let is_forward = self.speed > R::ZERO;
        let shown = if is_forward { shown } else { -shown };
        let missing = self.missing + self.speed.abs() - shown;
        self.missing = missing.clamp(R::ZERO, R::ONE);
        if self.missing > config.doubt {
            self.doubt(config, duty, is_forward);
        }
    }

    /// A whisker that moves has no more friction than drives it.
    #[cold]
    fn learn(&mut self, config: &ModelConfig<R>, duty: R, velocity: R) {
        let drives = (duty > R::ZERO) == (velocity > R::ZERO);
        if drives && duty.is_within(self.friction) {
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
        self.phase = Phase::Test(Test::new(config, !is_forward));
    }

    /// A tick of a test.
    #[cold]
    fn go_on(
        &mut self,
        config: &ModelConfig<R>,
        duty: R,
        velocity: R,
        moved: i32,
    ) -> Result<(), Unturned> {
        let Phase::Test(test) = &mut self.phase else {
            return Ok(());
        };
        // More friction than the model's is not relied on to stop the whisker.
        self.speed = config.moved_on(self.speed, duty, config.friction);
        let moves = self.speed != R::ZERO;
        let turns = moves && (self.speed > R::ZERO) == test.is_forward;
        test.seen = test.seen.saturating_add(moved.unsigned_abs());
        if test.ticks <= test.end {
            test.ticks = test.ticks.saturating_add(1);
            let is_old = (velocity > R::ZERO) != test.is_forward;
            test.is_old &= is_old && !velocity.is_within(config.slow);
            if (moves && !turns) || test.is_old {
                // Still on its old way, of which an encoder says nothing here.
                test.end = test.ticks.saturating_add(config.stroke);
                return Ok(());
            }
            let moved = if test.is_forward {
                moved
            } else {
                moved.wrapping_neg()
            };
            test.at = test.at.saturating_add(moved);
            test.least = test.least.min(test.at);
            test.follows = (velocity > R::ZERO) == test.is_forward;
            return Ok(());
        }
        // It is braked for as long as the model moves on.
        if turns {
            return Ok(());
        }
        let turned = test.at.saturating_sub(test.least);
        if turned < config.turned || !test.follows {
            return Err(if test.seen == 0 {
                Unturned::Silent
            } else if test.at <= -config.turned {
                Unturned::Backwards
            } else {
                Unturned::Still
            });
        }
        *self = Self {
            phase: Phase::Grace(config.grace),
            friction: self.friction,
            ..Self::default()
        };
        Ok(())
    }
}
