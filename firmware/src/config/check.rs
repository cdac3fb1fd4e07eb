//! Whether a configuration from outside can be ticked by: each value with the largest that it
//! can be, which is what a scene's ranges come to at any rate of ticks.
//!
//! Coarser than a scene's own ranges, and quick in every number format: no float is computed
//! with. What passes cannot make a tick fail or leave the bounds that its states have.

use tactile::{ClassSetting, Deciding, MOST_THRESHOLD, RuleSettings};
use whisking::motor::{Driver, GuardConfig, HomingConfig, ModelConfig};
use whisking::{
    Bound, Bounded, MAX_WHISKERS, Real, Start, filter, gate, muscle, noise, oscillator, pd,
};

use super::{Config, ConfigError, HeadConfig, Links, MotionConfig, Part, SensingConfig};
use crate::numbered::numbered;
use crate::perception::ClassifierConfig;
use crate::servo::ServoConfig;

macro_rules! fields {
    ($($rows:tt)*) => {
        numbered! {
            /// A value of a configuration, or some that belong together.
            Field: $($rows)*
        }
    };
}

/// Hands every [`Field`] to the macro `$then`: a logger wants texts as literals.
#[doc(hidden)]
#[macro_export]
macro_rules! config_fields {
    ($then:ident) => {
        $then! {
            Name = 1: "name";
            TickHz = 2: "tick_hz";
            Sides = 3: "head.sides";
            Whiskers = 4: "head.whiskers_per_side";
            SensorMode = 5: "sensor.model, sensor.mode";
            SensorLimits = 6: "sensor limits";
            Zero = 7: "zero of the sensor";
            Contact = 8: "contact filter";
            Motion = 9: "motion";
            Integrator = 10: "integrator";
            Oscillators = 11: "oscillators";
            Muscles = 12: "muscles";
            Rcp = 13: "rcp";
            Cia = 14: "cia";
            Noise = 15: "noise";
            Start = 16: "whisking.start";
            Seed = 17: "seed";
            Driver = 18: "motor.driver";
            OnFault = 19: "motor.on_fault";
            Arm = 20: "motor.arm";
            Kp = 21: "motor.kp";
            Kd = 22: "motor.kd";
            Angles = 23: "motor.min_deg, motor.max_deg";
            DutyLimit = 24: "motor.duty_limit";
            Slew = 25: "motor.slew_per_s";
            Encoder = 26: "motor.gear, motor.counts_per_rev";
            Guards = 27: "guards of the motor";
            Approach = 28: "motor.approach_deg_s";
            Homing = 29: "homing";
            Retry = 30: "retry after a fault";
            Classifier = 31: "classifier";
            Rule = 32: "classifier.rule";
            Window = 33: "classifier.window";
            Deciding = 34: "classifier.whiskers";
            ContactMin = 35: "classifier.contact_min";
            SerialBaud = 36: "telemetry.serial_baud";
            Links = 37: "telemetry";
            Following = 38: "motor.following_limit_deg";
            Travel = 39: "motor.travel_margin_deg";
            TopSpeed = 40: "motor.top_speed_deg_s";
            Friction = 41: "motor.unmoved_duty";
            TimeConstant = 42: "motor.time_constant_s";
            Heat = 43: "motor.continuous_duty";
            SelfMotion = 44: "sensor.self_motion_s";
            Classes = 45: "priors or thresholds of classes";
            Bus = 46: "head.nodes";
        }
    };
}
config_fields!(fields);

impl Field {
    /// Whether an image of these parts may refuse it: where it cannot, it needs no text.
    pub const fn can_be_refused(self) -> bool {
        // By codes, which never change: of whisking and motors, then of the classifier.
        match self.code() {
            _ if !Part::TAKES_CONFIGURATIONS => false,
            9..=30 | 38..=43 => Part::Motion.is_built(),
            31..=35 | 45 => Part::Classifier.is_built(),
            _ => true,
        }
    }
}

/// A share, 0 to 1.
const SHARE: Bound = Bound::positive(0);
/// A factor of an oscillator or a muscle.
const FACTOR: Bound = Bound::signed(1);
/// An angle as protraction: 360 degrees are 3.1, −360 are −4.1.
const ANGLE: Bound = Bound::signed(3);
/// Q24, up to 2.
const Q24: Bound = Bound::positive(25);
/// A state of an oscillator or a muscle.
const STATE: Bound = Bound::signed(2);

type Checked = Result<(), ConfigError>;

#[inline]
fn require(field: Field, holds: bool) -> Checked {
    if holds {
        Ok(())
    } else {
        Err(ConfigError::Range(field))
    }
}

fn within<T: Bounded>(field: Field, values: &[T], bound: Bound) -> Checked {
    require(field, values.iter().all(|value| value.lies_within(bound)))
}

#[inline]
fn built(part: Part) -> Checked {
    if part.is_built() {
        Ok(())
    } else {
        Err(ConfigError::NotBuilt(part))
    }
}

#[inline]
fn if_there<T>(part: Part, value: Option<&T>, check: impl FnOnce(&T) -> Checked) -> Checked {
    value.map_or(Ok(()), |value| {
        built(part)?;
        check(value)
    })
}

impl<R: Real> Config<R> {
    /// Whether a tick can run by it, in this image.
    ///
    /// # Errors
    /// [`ConfigError::Range`] names the field that is out of its range, or contradicts another;
    /// [`ConfigError::NotBuilt`] the part that this image was built without.
    pub fn check(&self) -> Result<(), ConfigError> {
        self.head.check()?;
        self.sensor.check()?;
        self.links.check()?;
        if_there(Part::Contact, self.contact.as_ref(), contact)?;
        if let Some(motion) = &self.motion {
            built(Part::Motion)?;
            motion.check(&self.head)?;
        }
        if_there(Part::Classifier, self.classifier.as_ref(), classifier)?;
        classes(&self.classes)
    }
}

impl<R: Real> Config<R> {
    /// Names the limit that does not protect a motor that is real, or the gain to change.
    pub(super) fn protects(&self) -> Checked {
        let motion = self.motion.as_ref().filter(|_| Part::Motion.is_built());
        let protects = motion.map_or(Ok(()), |motion| motion.protects(self.head.tick_hz));
        protects.map_err(ConfigError::Range)
    }
}

impl HeadConfig {
    fn check(&self) -> Checked {
        // Both come onto lines, and nothing else may begin there.
        let mut bytes = self.name.bytes().chain(self.overrides.bytes());
        let is_seen = |byte: u8| byte == b' ' || byte.is_ascii_graphic();
        require(Field::Name, bytes.all(is_seen))?;
        require(Field::TickHz, (200..=20_000).contains(&self.tick_hz))?;
        require(Field::Sides, (1..=2).contains(&self.sides))?;
        require(Field::Whiskers, (1..=12).contains(&self.whiskers_per_side))?;
        if self.whiskers() > MAX_WHISKERS {
            return Err(ConfigError::Room(Field::Whiskers));
        }
        if_there(Part::Bus, self.bus.as_ref(), |bus| {
            let is_shared = (2..=can::MAX_NODES).contains(&bus.nodes.into())
                && self.whiskers().is_multiple_of(bus.nodes.into());
            require(Field::Bus, is_shared && (125..=1000).contains(&bus.kbit_s))
        })
    }
}

impl SensingConfig {
    fn check(&self) -> Checked {
        built(self.kind.part())?;
        let zero = |zero: &crate::ZeroLimits| require(Field::Zero, zero.ticks > 0 && zero.calm > 0);
        if_there(Part::Zero, self.limits.zero.as_ref(), zero)?;
        let is_rate = |rate: &u16| require(Field::SelfMotion, (1..=1 << 15).contains(rate));
        if_there(Part::SelfMotion, self.self_motion.as_ref(), is_rate)
    }
}

impl Links {
    fn check(&self) -> Checked {
        if self.has_rtt {
            built(Part::Rtt)?;
        }
        if self.has_pins {
            built(Part::Pins)?;
        }
        let is_baud = |baud: &u32| require(Field::SerialBaud, (9_600..=2_000_000).contains(baud));
        if_there(Part::Serial, self.serial_baud.as_ref(), is_baud)
    }
}

fn contact<R: Real>(h50: &filter::Config<R>) -> Checked {
    let filter::Config { first, second } = h50;
    within(Field::Contact, &[*first], Bound::positive(1))?;
    within(Field::Contact, second, Bound::positive(1))
}

fn classifier<R: Real>(classifier: &ClassifierConfig<R>) -> Checked {
    match classifier.rule {
        Some(RuleSettings::Sequential(_)) => built(Part::Sequential)?,
        Some(RuleSettings::Window(samples)) => {
            built(Part::Window)?;
            let is_one = (1..=1_000_000).contains(&samples);
            require(
                Field::Window,
                is_one && classifier.deciding != Deciding::Together,
            )?;
        }
        None => {}
    }
    if classifier.deciding != Deciding::First {
        built(Part::Several)?;
    }
    if classifier.says_pose {
        built(Part::Pose)?;
    }
    within(Field::ContactMin, classifier.contact_min.as_slice(), SHARE)
}

/// The likeliest class lies behind none, and no threshold is one that evidence cannot reach.
fn classes(classes: &[ClassSetting]) -> Checked {
    let is_in_range = |class: &ClassSetting| class.threshold <= MOST_THRESHOLD;
    let has_likeliest = classes.is_empty() || classes.iter().any(|class| class.prior == 0);
    require(
        Field::Classes,
        !Part::Priors.is_built() || has_likeliest && classes.iter().all(is_in_range),
    )
}

impl<R: Real> MotionConfig<R> {
    fn check(&self, head: &HeadConfig) -> Checked {
        match self.driver {
            Driver::HBridge => built(Part::HBridge)?,
            Driver::SixStep => built(Part::SixStep)?,
        }
        let whisking::Config {
            oscillators,
            muscle,
            peak_gain,
            rcp,
            cia,
            noise,
        } = &self.whisking;
        match (oscillators, muscle) {
            (oscillator::Config::Euler(_), muscle::Config::Euler(_)) => built(Part::Euler)?,
            (oscillator::Config::Exact(_), muscle::Config::Exact(_)) => built(Part::Exact)?,
            _ => return Err(ConfigError::Range(Field::Integrator)),
        }
        of_oscillators(oscillators)?;
        within(Field::Muscles, &[*peak_gain], Bound::positive(1))?;
        of_muscles(muscle)?;
        if_there(Part::Rcp, rcp.as_ref(), |rcp| {
            of_gate::<R>(Field::Rcp, rcp.gain, &rcp.decay)
        })?;
        if_there(Part::Cia, cia.as_ref(), |cia| {
            of_gate::<R>(Field::Cia, cia.gain, &cia.decay)
        })?;
        if_there(Part::Noise, noise.as_ref(), |noise: &noise::Config<R>| {
            within(Field::Noise, &[noise.amplitude], SHARE)?;
            contact(&noise.filter).map_err(|_| ConfigError::Range(Field::Noise))
        })?;
        of_start(&self.start, head)?;
        of_servo(&self.servo)
    }
}

fn of_gate<R: Real>(field: Field, gain: R::Coefficient, decay: &gate::Decay<R>) -> Checked {
    within(field, &[gain], Bound::positive(7))?;
    within(field, &[decay.tick], SHARE)?;
    within(field, &[decay.half], SHARE)
}

fn of_oscillators<R: Real>(oscillators: &oscillator::Config<R>) -> Checked {
    let field = Field::Oscillators;
    match oscillators {
        oscillator::Config::Euler(oscillator::Euler {
            relax,
            turn,
            couple,
        }) => {
            within(field, &[*relax, *turn], SHARE)?;
            within(field, &[*couple], SHARE)
        }
        oscillator::Config::Exact(exact) => {
            for turn in [exact.tick, exact.half, exact.back].as_flattened() {
                within(field, &turn.shrink, FACTOR)?;
                within(field, &[turn.cross], FACTOR)?;
            }
            within(field, &exact.drive, FACTOR)?;
            within(field, &[exact.relax], SHARE)?;
            within(field, &[exact.half_relax], SHARE)
        }
    }
}

fn of_muscles<R: Real>(muscle: &muscle::Config<R>) -> Checked {
    let field = Field::Muscles;
    match muscle {
        muscle::Config::Euler(muscle::Euler { spring, damping }) => {
            within(field, &[*spring], FACTOR)?;
            within(field, &[*damping], Bound::positive(3))
        }
        muscle::Config::Exact(exact) => {
            for lag in &exact.lags {
                within(field, &[lag.decay], SHARE)?;
                within(field, &[lag.predict], FACTOR)?;
                within(field, &[lag.correct], FACTOR)?;
            }
            within(field, &[exact.lead], FACTOR)
        }
    }
}

/// As many sides and whiskers as the head has, the left side's first.
fn of_start<R: Real>(start: &Start<R>, head: &HeadConfig) -> Checked {
    let field = Field::Start;
    require(field, start.sides.len() == usize::from(head.sides))?;
    require(field, start.whiskers.len() == head.whiskers())?;
    for side in &start.sides {
        within(field, &side.oscillator, STATE)?;
        within(field, &[side.drive], SHARE)?;
    }
    let a_side = usize::from(head.whiskers_per_side).max(1);
    for (n, whisker) in start.whiskers.iter().enumerate() {
        require(field, usize::from(whisker.side) == n / a_side)?;
        within(field, &[whisker.gain], Bound::positive(1))?;
        within(field, &whisker.history.force, STATE)?;
    }
    Ok(())
}

fn of_servo<R: Real>(servo: &ServoConfig<R>) -> Checked {
    let pd::Config {
        kp,
        kd,
        smooth,
        theta_per_count,
        min,
        max,
        limit,
        slew,
    } = &servo.pd;
    // 10 of duty a degree, 1 of duty a degree a second at 20,000 ticks a second.
    within(Field::Kp, &[*kp], Bound::positive(10))?;
    within(Field::Kd, &[*kd], Bound::positive(21))?;
    within(Field::Kd, &[*smooth], SHARE)?;
    within(Field::Encoder, &[*theta_per_count], Bound::positive(2))?;
    within(Field::Angles, &[*min, *max], ANGLE)?;
    require(Field::Angles, min <= max)?;
    within(Field::DutyLimit, &[*limit], Bound::positive(24))?;
    within(Field::Slew, &[*slew], Q24)?;
    within(Field::Approach, &[servo.approach], Bound::positive(3))?;
    let GuardConfig {
        stall,
        error,
        travel: [lowest, highest],
        heat,
        heat_shift,
        model,
        ..
    } = &servo.guards;
    within(Field::Guards, &[stall.threshold], SHARE)?;
    within(Field::Guards, &[*error], Bound::positive(7))?;
    within(Field::Guards, &[*heat], Bound::positive(30))?;
    require(Field::Guards, lowest <= highest && *heat_shift < 32)?;
    if let Some(model) = model {
        moves(model)?;
    }
    if_there(
        Part::Homing,
        servo.homing.as_ref(),
        |homing: &HomingConfig| within(Field::Homing, &[homing.duty], SHARE),
    )
}

fn moves<R: Real>(model: &ModelConfig<R>) -> Checked {
    let ModelConfig {
        speed,
        rate,
        braked,
        shown,
        root_stop,
        friction,
        slow,
        doubt,
        missing,
        test,
        learn,
        ..
    } = model;
    let guards = |factors: &[R::Coefficient], bound| within(Field::Guards, factors, bound);
    // 800,000 degrees a second at 200 ticks a second.
    guards(&[*speed, *shown, *braked], Bound::positive(5))?;
    guards(&[*rate, *learn], SHARE)?;
    // Where a motor hardly accelerates, the way to a stop is long.
    guards(&[*root_stop], Bound::positive(29))?;
    within(Field::Guards, &[*friction, *slow, *doubt, *missing], SHARE)?;
    within(Field::Guards, &[*test], Bound::positive(24))
}
