//! The constants of each part, with the largest that they can be: what a scene's ranges come to
//! at any rate of ticks.

use tactile::{AnyRuleSettings, Threshold};
use whisking::motor::{GuardConfig, HomingConfig};
use whisking::{AsWords, Bound, Optional, Real, WordRow, gate, muscle, noise, oscillator, pd};

use super::{Tunable, Visitor, number};
use crate::{ActiveConfig, ClassifyingConfig, Config, SensorLimits, ServoConfig};

/// Any integer of its type that is not negative.
const COUNT: Bound = Bound::positive(32);
/// Any integer.
const SIGNED_COUNT: Bound = Bound::signed(32);
/// A share, 0 to 1.
const SHARE: Bound = Bound::positive(0);
/// A factor of an oscillator or a muscle.
const FACTOR: Bound = Bound::signed(1);
/// An angle as protraction: 360 degrees are 3.1, −360 are −4.1.
const ANGLE: Bound = Bound::signed(3);
/// Q24, up to 2.
const Q24: Bound = Bound::positive(25);

impl<R, M, P, H> Tunable<R> for Config<M, P, H>
where
    M: Tunable<R>,
    P: Tunable<R>,
{
    fn visit(&mut self, visitor: &mut impl Visitor) {
        let SensorLimits {
            frozen,
            stale,
            jump,
            ..
        } = &mut self.sensor_limits;
        visitor.constant(number::FROZEN, frozen, COUNT);
        visitor.constant(number::STALE, stale, COUNT);
        visitor.constant(number::JUMP, jump, COUNT);
        self.perception.visit(visitor);
        self.motion.visit(visitor);
    }
}

impl<R, T, D> Tunable<R> for ClassifyingConfig<T, D>
where
    R: Real,
    T: Optional<R>,
    D: Tunable<R>,
{
    fn visit(&mut self, visitor: &mut impl Visitor) {
        if let Some(least) = self.contact_min.part_mut() {
            visitor.constant(number::CONTACT_MIN, least, SHARE);
        }
        self.rule.visit(visitor);
    }
}

/// A threshold as a constant.
#[derive(Clone, Copy)]
struct Odds(Threshold);

impl AsWords for Odds {
    fn words(self) -> [u32; 2] {
        self.0.words()
    }

    fn from_words(words: [u32; 2], _: Bound) -> Option<Self> {
        Threshold::from_words(words).map(Self)
    }

    fn value(self) -> f64 {
        self.0.odds()
    }
}

impl<R> Tunable<R> for Threshold {
    fn visit(&mut self, visitor: &mut impl Visitor) {
        let mut odds = Odds(*self);
        visitor.constant(number::THRESHOLD, &mut odds, COUNT);
        *self = odds.0;
    }
}

/// A window: its length is no constant, as sums of one are under way.
impl<R> Tunable<R> for u32 {
    fn visit(&mut self, _: &mut impl Visitor) {}
}

impl<R> Tunable<R> for AnyRuleSettings {
    fn visit(&mut self, visitor: &mut impl Visitor) {
        match self {
            Self::Sequential(threshold) => Tunable::<R>::visit(threshold, visitor),
            Self::Window(samples) => Tunable::<R>::visit(samples, visitor),
        }
    }
}

impl<R, W, A, H> Tunable<R> for ActiveConfig<R, W, A, H>
where
    R: Real,
    W: Tunable<R>,
    H: Optional<HomingConfig>,
{
    fn visit(&mut self, visitor: &mut impl Visitor) {
        self.servo.visit(visitor);
        self.whisking.visit(visitor);
    }
}

impl<R: Real, H: Optional<HomingConfig>> Tunable<R> for ServoConfig<R, H> {
    fn visit(&mut self, visitor: &mut impl Visitor) {
        let pd::Config {
            kp,
            kd,
            min,
            max,
            limit,
            slew,
            ..
        } = &mut self.pd;
        // 10 of duty a degree, 1 of duty a degree a second at 20,000 ticks a second.
        visitor.constant(number::KP, kp, Bound::positive(10));
        visitor.constant(number::KD, kd, Bound::positive(21));
        visitor.constant(number::MIN, min, ANGLE);
        visitor.constant(number::MAX, max, ANGLE);
        visitor.constant(number::DUTY_LIMIT, limit, Bound::positive(24));
        visitor.constant(number::SLEW, slew, Q24);
        let GuardConfig {
            stall,
            unmoved,
            error,
            speed,
            travel: [lowest, highest],
            heat,
            ..
        } = &mut self.guards;
        visitor.constant(number::HARD, &mut stall.threshold, SHARE);
        visitor.constant(number::UNMOVED, unmoved, COUNT);
        visitor.constant(number::FOLLOWING, error, Bound::positive(3));
        visitor.constant(number::SPEED, speed, COUNT);
        visitor.constant(number::TRAVEL_LOW, lowest, SIGNED_COUNT);
        visitor.constant(number::TRAVEL_HIGH, highest, SIGNED_COUNT);
        visitor.constant(number::HEAT, heat, Bound::positive(30));
        visitor.constant(number::APPROACH, &mut self.approach, Bound::positive(3));
        if let Some(HomingConfig { duty, stop, .. }) = self.homing.part_mut() {
            visitor.constant(number::HOMING_DUTY, duty, SHARE);
            visitor.constant(number::HOMING_STOP, stop, SIGNED_COUNT);
        }
    }
}

impl<R, O, M, Rcp, Cia, N> Tunable<R> for whisking::Config<R, O, M, Rcp, Cia, N>
where
    R: Real,
    O: Tunable<R>,
    M: Tunable<R>,
    Rcp: Optional<gate::Rcp<R>>,
    Cia: Optional<gate::Cia<R>>,
    N: Optional<noise::Config<R>>,
{
    fn visit(&mut self, visitor: &mut impl Visitor) {
        if let Some(gate::Rcp { gain, decay }) = self.rcp.part_mut() {
            of_gate::<R>(number::RCP_GAIN, gain, decay, visitor);
        }
        if let Some(gate::Cia { gain, decay }) = self.cia.part_mut() {
            of_gate::<R>(number::CIA_GAIN, gain, decay, visitor);
        }
        if let Some(noise::Config { amplitude, .. }) = self.noise.part_mut() {
            visitor.constant(number::NOISE, amplitude, SHARE);
        }
        self.oscillators.visit(visitor);
        self.muscle.visit(visitor);
    }
}

/// A gain, 0 to 100, and a decay.
fn of_gate<R: Real>(
    first: u8,
    gain: &mut R::Coefficient,
    decay: &mut gate::Decay<R>,
    visitor: &mut impl Visitor,
) {
    visitor.constant(first, gain, Bound::positive(7));
    visitor.constant(first + 1, &mut decay.tick, SHARE);
    visitor.constant(first + 2, &mut decay.half, SHARE);
    visitor.constant(first + 3, &mut decay.slow, COUNT);
}

impl<R: Real> Tunable<R> for oscillator::Config<R> {
    fn visit(&mut self, visitor: &mut impl Visitor) {
        match self {
            Self::Euler(euler) => euler.visit(visitor),
            Self::Exact(exact) => exact.visit(visitor),
        }
    }
}

impl<R: Real> Tunable<R> for oscillator::Euler<R> {
    fn visit(&mut self, visitor: &mut impl Visitor) {
        visitor.constant(number::EULER_RELAX, &mut self.relax, SHARE);
        visitor.constant(number::EULER_TURN, &mut self.turn, SHARE);
        visitor.constant(number::EULER_COUPLE, &mut self.couple, SHARE);
    }
}

impl<R: Real> Tunable<R> for oscillator::Exact<R> {
    fn visit(&mut self, visitor: &mut impl Visitor) {
        turns(number::TURN_TICK, &mut self.tick, visitor);
        turns(number::TURN_HALF, &mut self.half, visitor);
        turns(number::TURN_BACK, &mut self.back, visitor);
        let [mean, difference] = &mut self.drive;
        row(number::DRIVE, mean, 2, visitor);
        row(number::DRIVE + 2, difference, 2, visitor);
        visitor.constant(number::RELAX, &mut self.relax, SHARE);
        visitor.constant(number::HALF_RELAX, &mut self.half_relax, SHARE);
    }
}

/// Three constants of the mean of the sides, and three of their difference.
fn turns<R: Real>(first: u8, of: &mut [oscillator::Turn<R>; 2], visitor: &mut impl Visitor) {
    let [mean, difference] = of;
    for (first, turn) in [(first, mean), (first + 3, difference)] {
        let [x, y] = &mut turn.shrink;
        visitor.constant(first, x, FACTOR);
        visitor.constant(first + 1, y, FACTOR);
        visitor.constant(first + 2, &mut turn.cross, FACTOR);
    }
}

fn row<T: WordRow>(first: u8, of: &mut T, count: u8, visitor: &mut impl Visitor) {
    for n in 0..count {
        visitor.in_row(first + n, of, usize::from(n), FACTOR);
    }
}

impl<R: Real> Tunable<R> for muscle::Config<R> {
    fn visit(&mut self, visitor: &mut impl Visitor) {
        match self {
            Self::Euler(euler) => euler.visit(visitor),
            Self::Exact(exact) => exact.visit(visitor),
        }
    }
}

impl<R: Real> Tunable<R> for muscle::Euler<R> {
    fn visit(&mut self, visitor: &mut impl Visitor) {
        visitor.constant(number::EULER_SPRING, &mut self.spring, FACTOR);
        visitor.constant(number::EULER_DAMPING, &mut self.damping, Bound::positive(3));
    }
}

impl<R: Real> Tunable<R> for muscle::Exact<R> {
    fn visit(&mut self, visitor: &mut impl Visitor) {
        let [slow, fast] = &mut self.lags;
        for (first, lag) in [(number::SLOW_LAG, slow), (number::FAST_LAG, fast)] {
            visitor.constant(first, &mut lag.decay, SHARE);
            row(first + 1, &mut lag.predict, 3, visitor);
            visitor.constant(first + 4, &mut lag.correct, FACTOR);
        }
    }
}
