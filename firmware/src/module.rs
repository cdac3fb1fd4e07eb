//! The tick.

use heapless::Vec;
use tactile::SelfMotion;
use whisking::motor::MotorDriver;
use whisking::{MAX_OWN, MAX_SIDES, Number, Real, filter};

use crate::config::Part;
use crate::io::{AngleInput, Clock, WordSource};
use crate::motion::{Command, Motion, NoActiveWhisker, NotDone};
use crate::perception::{Perception, SampleClassifier};
use crate::sensing::{Reading, Sensor, SensorLimits, Swing};
use crate::servo::Servo;
use crate::{Config, Event, MotionConfig, Place, Timing, ZeroLimits};

/// What a module is made of: a board's, or a simulation's.
pub trait Hardware {
    /// Where a whisker's words come from.
    type Source: WordSource;
    /// What drives a motor.
    type Motor: MotorDriver;
    /// Where a whisker's angle comes from.
    type Angle: AngleInput;
    /// What decides by samples.
    type Classifier: SampleClassifier;
    /// What ticks are timed by.
    type Clock: Clock;
}

/// The hardware of one whisker.
pub struct WhiskerParts<H: Hardware> {
    /// Its sensor.
    pub source: H::Source,
    /// Its motor and its angle; `None`: it is passive.
    pub motor: Option<(H::Motor, H::Angle)>,
}

/// A filter of self-motion, or none.
const OWN: usize = Part::SelfMotion.is_built() as usize;

/// Sides of which other boards feel something.
const ELSEWHERE: usize = if Part::Bus.is_built() { MAX_SIDES } else { 0 };

/// One whisker, in one tick.
pub struct Whisker<R, H: Hardware> {
    place: Place,
    sensor: Sensor<H::Source>,
    filter: filter::State<R>,
    /// What whisking alone makes it read, where the program has that.
    own: [SelfMotion; OWN],
    /// Of x in this tick, codes.
    predicted: i16,
    felt: R,
    /// What counts of its reading: nothing while its motor [inhibits](Servo::is_inhibited) it.
    reading: Reading,
    swing: Swing,
    servo: Option<Servo<R, H::Motor, H::Angle>>,
}

impl<R: Real, H: Hardware> Whisker<R, H> {
    /// Where it stands.
    pub const fn place(&self) -> Place {
        self.place
    }

    /// Its sensor.
    pub const fn sensor(&self) -> &Sensor<H::Source> {
        &self.sensor
    }

    /// Its sensor.
    pub const fn sensor_mut(&mut self) -> &mut Sensor<H::Source> {
        &mut self.sensor
    }

    /// Its contact π in the last tick.
    #[inline]
    pub const fn felt(&self) -> R {
        if Part::Contact.is_built() {
            self.felt
        } else {
            R::ZERO
        }
    }

    /// Its motor, if it has one.
    #[inline]
    pub fn servo(&self) -> Option<&Servo<R, H::Motor, H::Angle>> {
        self.servo.as_ref().filter(|_| Part::Motion.is_built())
    }

    #[inline]
    fn servo_mut(&mut self) -> Option<&mut Servo<R, H::Motor, H::Angle>> {
        self.servo.as_mut().filter(|_| Part::Motion.is_built())
    }
}

/// A module: its whiskers, left side first, their pattern generator, and what they decide.
pub struct Module<R: Real, H: Hardware> {
    whiskers: Vec<Whisker<R, H>, MAX_OWN>,
    contact: [R; MAX_SIDES],
    /// What the other boards of its head feel.
    elsewhere: [R; ELSEWHERE],
    motion: Option<Motion<R>>,
    perception: Option<Perception<H::Classifier>>,
    clock: H::Clock,
    /// Counts of the clock between ticks; 0 where they mean nothing.
    period: u32,
    timing: Timing,
}

impl<R: Real, H: Hardware> Module<R, H> {
    /// A module that has not ticked yet, by a configuration that is [checked](Config::check);
    /// `parts` is the hardware of each whisker, left side first.
    ///
    /// Its motors are off and not armed, its whiskers at rest (θ = 0) where they now are.
    pub fn new(
        config: &Config<R>,
        parts: impl IntoIterator<Item = WhiskerParts<H>>,
        classifier: Option<H::Classifier>,
        clock: (H::Clock, u32),
    ) -> Self {
        Self::of_node(config, 0, parts, classifier, clock)
    }

    /// That of a board of a head, whose whiskers are those [of its node](crate::HeadConfig::of_node).
    pub fn of_node(
        config: &Config<R>,
        number: u8,
        parts: impl IntoIterator<Item = WhiskerParts<H>>,
        classifier: Option<H::Classifier>,
        clock: (H::Clock, u32),
    ) -> Self {
        let mut module = Self::empty(clock);
        module.build(config, number, parts, classifier);
        module
    }

    /// One without whiskers, which [`build`](Self::build) gives it.
    pub fn empty((clock, period): (H::Clock, u32)) -> Self {
        Self {
            whiskers: Vec::new(),
            contact: [R::ZERO; MAX_SIDES],
            elsewhere: [R::ZERO; ELSEWHERE],
            motion: None,
            perception: None,
            clock,
            period,
            timing: Timing::default(),
        }
    }

    /// Makes an [empty](Self::empty) module what [`of_node`](Self::of_node) makes, where it lies:
    /// for a board, whose stack has no room for it.
    #[inline]
    pub fn build(
        &mut self,
        config: &Config<R>,
        number: u8,
        parts: impl IntoIterator<Item = WhiskerParts<H>>,
        classifier: Option<H::Classifier>,
    ) {
        let finds_zero = config.sensor.limits.zero.is_some();
        let rate = config.sensor.self_motion.unwrap_or_default();
        let own = config.head.of_node(number);
        let a_side = usize::from(config.head.whiskers_per_side).max(1);
        for (n, WhiskerParts { source, motor }) in own.clone().zip(parts) {
            let place = Place::new((n / a_side) as u8, (n % a_side) as u8);
            // As many as a checked configuration has, there is room for.
            let _ = self.whiskers.push(Whisker {
                place,
                sensor: Sensor::new(source, finds_zero),
                filter: filter::State::default(),
                own: core::array::from_fn(|_| SelfMotion::new(rate)),
                predicted: 0,
                felt: R::ZERO,
                reading: Reading::REST,
                swing: Swing::new(),
                servo: motor
                    .filter(|_| Part::Motion.is_built())
                    .map(|(motor, angle)| Servo::new(motor, angle)),
            });
        }
        let count = self.whiskers.len();
        if Part::Motion.is_built() {
            let of_own = |motion| Motion::new(motion, own.clone());
            self.motion = config.motion.as_ref().map(of_own);
        }
        if Part::Classifier.is_built() {
            let perceives = |classifier| Perception::new(classifier, count, config.head.tick_hz);
            self.perception = classifier.map(perceives);
        }
    }

    /// A whisker that is inhibited, as its motor is being homed, may lean against its stop.
    #[inline]
    fn follow_zeros(&mut self, limits: ZeroLimits, events: &mut impl FnMut(Event)) {
        for whisker in &mut self.whiskers {
            let is_calm = whisker.reading.valid && whisker.felt.to_q24() < limits.calm;
            let moved = whisker
                .sensor
                .follow_zero(is_calm, limits, whisker.place, events);
            if let (Some(own), Some([by, _])) = (whisker.own.first_mut(), moved) {
                own.shift(by);
            }
        }
    }

    /// What whisking alone makes each whisker's x read, learnt by `rate` in the air. Nothing while
    /// its motor does not follow the pattern generator, nor where touches are not found.
    #[inline]
    fn predict(&mut self, rate: u16, config: &MotionConfig<R>) {
        let (Some(perception), Some(motion)) = (&self.perception, &self.motion) else {
            return;
        };
        let oscillators = &config.whisking.oscillators;
        for (n, whisker) in self.whiskers.iter_mut().enumerate() {
            let is_whisked = whisker.servo.as_ref().is_some_and(Servo::is_whisking);
            let reading = whisker.reading;
            whisker.predicted = 0;
            if let Some(own) = whisker.own.first_mut()
                && is_whisked
                && reading.valid
                && perception.listens_to(n)
            {
                let side = usize::from(whisker.place.side);
                let phase = oscillators.phase(&motion.state.oscillators, side);
                let is_in_air = reading.fresh && perception.is_air(n);
                whisker.predicted = own.step(reading.x.signed14(), phase, rate, is_in_air);
            }
        }
    }

    /// Contact π of each side: the largest |H50(x)| of its whiskers (BIOTACT eq. 9), without
    /// self-motion that is predicted. A whisker with a fault has none, and its filter is reset.
    #[inline]
    fn feel(&mut self, h50: &filter::Config<R>) {
        let mut most = const { [R::ZERO; MAX_SIDES] };
        for whisker in &mut self.whiskers {
            if whisker.reading.valid {
                let x = normalised::<R>(whisker.reading.x, whisker.predicted);
                whisker.felt = h50.process(&mut whisker.filter, x).abs();
            } else {
                whisker.filter = filter::State::default();
                whisker.felt = R::ZERO;
            }
            if let Some(most) = most.get_mut(usize::from(whisker.place.side)) {
                *most = whisker.felt.max(*most);
            }
        }
        self.contact = most;
    }

    /// Contact π of its whiskers of each side in the last tick; zero of a side that is not there.
    pub const fn contact(&self) -> [R; MAX_SIDES] {
        self.contact
    }

    /// Contact by which it is modulated: that of its whiskers, or of those of other boards.
    #[inline]
    fn contact_of_head(&self) -> [R; MAX_SIDES] {
        let mut most = self.contact;
        for (most, elsewhere) in most.iter_mut().zip(&self.elsewhere) {
            *most = elsewhere.max(*most);
        }
        most
    }

    /// What the other boards of its head feel, from the next tick on.
    pub fn feel_elsewhere(&mut self, contact: [R; MAX_SIDES]) {
        for (own, contact) in self.elsewhere.iter_mut().zip(contact) {
            *own = contact;
        }
    }

    /// The whiskers, left side first.
    pub fn whiskers(&self) -> &[Whisker<R, H>] {
        &self.whiskers
    }

    /// The same, for a board's interrupts and a simulation's bus.
    pub fn whiskers_mut(&mut self) -> &mut [Whisker<R, H>] {
        &mut self.whiskers
    }

    /// The whisker at `place`.
    pub fn whisker(&self, place: Place) -> Option<(usize, &Whisker<R, H>)> {
        let mut all = self.whiskers.iter().enumerate();
        all.find(|(_, whisker)| whisker.place == place)
    }

    /// How it moves; `None`: its whiskers are passive.
    #[inline]
    pub fn motion(&self) -> Option<&Motion<R>> {
        self.motion.as_ref().filter(|_| Part::Motion.is_built())
    }

    #[inline]
    pub(crate) fn motion_mut(&mut self) -> Option<&mut Motion<R>> {
        self.motion.as_mut().filter(|_| Part::Motion.is_built())
    }

    /// What it decides, if anything.
    pub fn perception(&self) -> Option<&Perception<H::Classifier>> {
        let perception = self.perception.as_ref();
        perception.filter(|_| Part::Classifier.is_built())
    }

    /// What it decides, if anything.
    pub fn perception_mut(&mut self) -> Option<&mut Perception<H::Classifier>> {
        let perception = self.perception.as_mut();
        perception.filter(|_| Part::Classifier.is_built())
    }

    /// What it decides with, which leaves the module without it.
    pub const fn take_perception(&mut self) -> Option<Perception<H::Classifier>> {
        self.perception.take()
    }

    /// What it decides with, from another module.
    pub fn set_perception(&mut self, perception: Option<Perception<H::Classifier>>) {
        self.perception = perception;
    }

    /// Longest tick and missed deadlines.
    pub const fn timing(&self) -> &Timing {
        &self.timing
    }

    /// Longest tick and missed deadlines, to be taken.
    pub const fn timing_mut(&mut self) -> &mut Timing {
        &mut self.timing
    }

    /// By a configuration that this one [may become](Config::may_become), between two ticks.
    pub fn retune(&mut self, config: &Config<R>, next: &Config<R>) {
        if let (Some(perception), Some(classifier)) = (&mut self.perception, &next.classifier) {
            perception.retune(classifier.rule.as_ref(), &next.classes);
        }
        // Home was found by where the stop was taken to be.
        if Part::Homing.is_built() && stop_of(config) != stop_of(next) {
            let servos = self.whiskers.iter_mut().filter_map(Whisker::servo_mut);
            servos.for_each(Servo::forget_home);
        }
    }

    /// Whether motors are armed: otherwise they are off, and all else goes on.
    pub fn is_armed(&self) -> bool {
        self.motion().is_some_and(Motion::is_armed)
    }

    /// Carries out `command` for the whisker at `place`, between two ticks.
    ///
    /// # Errors
    /// [`NoActiveWhisker`] if there is none, or if it is passive; for [`Command::Clear`] as
    /// [`Servo::clear`].
    pub fn command(&mut self, place: Place, command: Command<R>) -> Result<(), NotDone> {
        let mut all = self.whiskers.iter_mut().enumerate();
        let found = all.find(|(_, whisker)| whisker.place == place);
        let (n, whisker) = found.ok_or(NoActiveWhisker)?;
        let servo = whisker.servo_mut().ok_or(NoActiveWhisker)?;
        match command {
            Command::Gain(gain) => {
                let motion = self.motion_mut().ok_or(NoActiveWhisker)?;
                motion.set_gain(n, gain)?;
            }
            Command::Setpoint(setpoint) => servo.set_setpoint(setpoint),
            Command::Clear => servo.clear()?,
            Command::Home => servo.home(),
        }
        Ok(())
    }

    /// Arms the motors of all whiskers, or keeps them off from the next tick on; all else goes on,
    /// and what [rests](Servo::rests) rests on. A module starts with motors that are not armed.
    /// Whoever arms them first says that their whiskers are at rest, unless they are homed.
    pub fn arm(&mut self, is_armed: bool) {
        let Some(motion) = self.motion_mut() else {
            return;
        };
        motion.set_armed(is_armed);
        if is_armed {
            let servos = self.whiskers.iter_mut().filter_map(Whisker::servo_mut);
            servos.for_each(Servo::arm);
        }
    }
}

impl<R: Number, H: Hardware> Module<R, H> {
    /// One tick. `events` gets what is worth reporting; nothing is formatted here.
    #[inline]
    pub fn tick(&mut self, config: &Config<R>, events: &mut impl FnMut(Event)) {
        self.timing.begin(self.clock.now(), self.period);
        let crate::SensingConfig {
            decoder, limits, ..
        } = &config.sensor;
        for whisker in &mut self.whiskers {
            let reading = whisker.sensor.read(*decoder, limits, whisker.place, events);
            let is_inhibited = whisker.servo().is_some_and(Servo::is_inhibited);
            whisker.reading = if is_inhibited || whisker.swing.is_lost() {
                Reading::FAULT
            } else {
                reading
            };
        }
        if Part::Contact.is_built()
            && let Some(h50) = &config.contact
        {
            if Part::SelfMotion.is_built()
                && let (Some(rate), Some(motion)) = (config.sensor.self_motion, &config.motion)
            {
                self.predict(rate, motion);
            }
            self.feel(h50);
            if Part::Zero.is_built()
                && let Some(limits) = config.sensor.limits.zero
            {
                self.follow_zeros(limits, events);
            }
        }
        if Part::Motion.is_built()
            && let Some(config) = &config.motion
        {
            self.step(config, limits, events);
        }
        if Part::Classifier.is_built()
            && let (Some(perception), Some(config)) = (&mut self.perception, &config.classifier)
        {
            for (n, whisker) in self.whiskers.iter().enumerate() {
                let felt = (whisker.reading, whisker.felt);
                perception.step((n, whisker.place), felt, config, events);
            }
        }
        self.timing.end(self.clock.now());
    }

    /// Moves the whiskers: pattern generator, then the servo of each.
    #[inline]
    fn step(
        &mut self,
        config: &MotionConfig<R>,
        limits: &SensorLimits,
        events: &mut impl FnMut(Event),
    ) {
        let contact = self.contact_of_head();
        let Some(motion) = &mut self.motion else {
            return;
        };
        config.whisking.step(&mut motion.state, &contact);
        let has_fault = |whisker: &Whisker<R, H>| {
            !whisker.sensor.reading().valid || whisker.servo.as_ref().is_some_and(Servo::rests)
        };
        let all_stop = config.stops_all && self.whiskers.iter().any(has_fault);
        for (whisker, moved) in self.whiskers.iter_mut().zip(&motion.state.whiskers) {
            let is_valid = whisker.sensor.reading().valid;
            let may_run = motion.is_armed && is_valid && !all_stop;
            if let Some(servo) = &mut whisker.servo {
                servo.check_home(&config.servo, whisker.felt);
                let theta = moved.muscle.theta;
                servo.step(&config.servo, theta, may_run, whisker.place, events);
                let x = whisker.sensor.reading().x;
                if limits.swing.is_some()
                    && let Some(lost) = whisker.swing.look(limits, x, servo.running_at())
                {
                    events(Event::Limit(lost.number()));
                }
            }
        }
    }
}

/// The normalised reading, (code − 8192)/8191 limited to ±1: what
/// [`mlx90333::Word::normalised`] gives, within one rounding, less what was `predicted` of it.
#[inline]
fn normalised<R: Real>(word: mlx90333::Word, predicted: i16) -> R {
    // Limited as an integer, which costs less.
    let code = word.signed14();
    if Part::SelfMotion.is_built() {
        R::from_code(code.saturating_sub(predicted).clamp(-8191, 8191))
    } else {
        R::from_code(code.max(-8191))
    }
}

/// Where a servo takes the stop to be that it finds home by.
fn stop_of<R: Real>(config: &Config<R>) -> Option<i32> {
    Some(config.motion.as_ref()?.servo.homing.as_ref()?.stop)
}

#[cfg(test)]
mod tests {
    use mlx90333::Word;

    #[test]
    fn every_code_is_normalised_as_the_driver_does() {
        for code in 0..1 << 14 {
            let word = Word::new(code << 2);
            let found: f32 = super::normalised(word, 0);
            assert!((found - word.normalised()).abs() < 1.3e-7, "{code}");
        }
        assert_eq!(super::normalised::<f32>(Word::MID, 0), 0.0);
    }
}
