//! The tick.

use mlx90333::Decoder;
use whisking::{Optional, Real, filter};

use crate::sensing::{Reading, Sensor, SensorLimits};
use crate::zero::ZeroLimits;
use crate::{
    Clock, Command, Event, Motion, MotorControl, NoActiveWhisker, Perception, Place, Timing,
    WordSource,
};

/// The settings of a module: every constant that its tick reads. A board copies
/// them from flash to RAM when it starts. What is left out is left out by type:
/// `()` for motion or perception, [`Absent`](whisking::Absent) for the filter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Config<M, P, H> {
    /// How the sensors' frames are read.
    pub decoder: Decoder,
    /// What is borne of the sensors.
    pub sensor_limits: SensorLimits,
    /// H50 on x, where something needs contact signals.
    pub contact: H,
    /// How it moves.
    pub motion: M,
    /// What it decides.
    pub perception: P,
    /// Counts of the clock between ticks; 0 where they mean nothing.
    pub period: u32,
}

/// A module of `S` sides (1 or 2) with `N` whiskers each.
#[derive(Debug)]
pub struct Module<R, F, M, P, C, const S: usize, const N: usize> {
    sensors: [[Sensor<F>; N]; S],
    filters: [[filter::State<R>; N]; S],
    felt: [[R; N]; S],
    contact: [R; S],
    motion: M,
    perception: P,
    clock: C,
    timing: Timing,
}

impl<R, F, M, P, C, const S: usize, const N: usize> Module<R, F, M, P, C, S, N>
where
    R: Real,
    F: WordSource,
    C: Clock,
{
    /// A module that has not ticked yet, from its sensors (left side first),
    /// its motion, its perception and its clock.
    pub fn new(sources: [[F; N]; S], motion: M, perception: P, clock: C) -> Self {
        Self {
            sensors: sources.map(|side| side.map(Sensor::new)),
            filters: [[filter::State::default(); N]; S],
            felt: [[R::ZERO; N]; S],
            contact: [R::ZERO; S],
            motion,
            perception,
            clock,
            timing: Timing::default(),
        }
    }

    /// One tick. `events` gets what is worth telling; nothing is formatted here.
    #[inline]
    pub fn tick<MC, PC, H>(&mut self, config: &Config<MC, PC, H>, events: &mut impl FnMut(Event))
    where
        M: Motion<R, MC, S, N>,
        P: Perception<R, PC, S, N>,
        H: Optional<filter::Config<R>>,
    {
        self.timing.begin(self.clock.now(), config.period);

        let sensed = self.sense(config.decoder, config.sensor_limits, events);
        let mut readings = sensed;
        for (side, readings) in readings.iter_mut().enumerate() {
            for (w, reading) in readings.iter_mut().enumerate() {
                if self.motion.is_deaf(side, w) {
                    *reading = Reading::FAULT;
                }
            }
        }
        if let Some(h50) = config.contact.part() {
            self.feel(h50, &readings);
            self.follow_zeros(config.sensor_limits.zero, &readings, events);
        }
        self.motion
            .step(&config.motion, self.contact, &sensed, events);
        self.perception
            .step(&config.perception, &self.felt, &readings, events);

        self.timing.end(self.clock.now());
    }

    #[inline]
    fn sense(
        &mut self,
        decoder: Decoder,
        limits: SensorLimits,
        events: &mut impl FnMut(Event),
    ) -> [[Reading; N]; S] {
        let mut readings = [[Reading::REST; N]; S];
        for (side, (sensors, readings)) in self.sensors.iter_mut().zip(&mut readings).enumerate() {
            for (w, (sensor, reading)) in sensors.iter_mut().zip(readings).enumerate() {
                let place = Place::new(side as u8, w as u8);
                *reading = sensor.read(decoder, limits, place, events);
            }
        }
        readings
    }

    /// Follows the zeros of sensors, where they are found by themselves. A whisker that is
    /// deaf, as its motor is being homed, may lean against its stop.
    #[inline]
    fn follow_zeros(
        &mut self,
        limits: ZeroLimits,
        readings: &[[Reading; N]; S],
        events: &mut impl FnMut(Event),
    ) {
        for (side, sensors) in self.sensors.iter_mut().enumerate() {
            for (w, sensor) in sensors.iter_mut().enumerate() {
                let place = Place::new(side as u8, w as u8);
                let is_calm =
                    || readings[side][w].valid && self.felt[side][w].to_q24() < limits.calm;
                sensor.follow_zero(is_calm, limits, place, events);
            }
        }
    }

    /// Contact π of each side: the largest |H50(x)| of its whiskers (BIOTACT eq. 9). A
    /// whisker with a fault has none, and begins anew when it is gone.
    #[inline]
    fn feel(&mut self, h50: &filter::Config<R>, readings: &[[Reading; N]; S]) {
        for (side, felt) in self.felt.iter_mut().enumerate() {
            let whiskers = self.filters[side].iter_mut().zip(&readings[side]);
            for (felt, (filter, reading)) in felt.iter_mut().zip(whiskers) {
                if reading.valid {
                    *felt = h50.process(filter, normalised::<R>(reading.x)).abs();
                } else {
                    *filter = filter::State::default();
                    *felt = R::ZERO;
                }
            }
            // No comparison with zero where there is one whisker.
            let most = felt.iter().copied().reduce(|most, size| size.max(most));
            self.contact[side] = most.unwrap_or(R::ZERO);
        }
    }

    /// Contact π of each side in the last tick.
    pub const fn contact(&self) -> [R; S] {
        self.contact
    }

    /// Contact of each whisker in the last tick.
    pub const fn felt(&self) -> &[[R; N]; S] {
        &self.felt
    }

    /// The sensor of every whisker, left side first.
    pub const fn sensors(&self) -> &[[Sensor<F>; N]; S] {
        &self.sensors
    }

    /// How it moves.
    pub const fn motion(&self) -> &M {
        &self.motion
    }

    /// How it moves, for a simulation that looks at its hardware.
    pub const fn motion_mut(&mut self) -> &mut M {
        &mut self.motion
    }

    /// What it decides.
    pub const fn perception_mut(&mut self) -> &mut P {
        &mut self.perception
    }

    /// The sensor of a whisker, left side first.
    pub fn sensor_mut(&mut self, side: usize, whisker: usize) -> Option<&mut Sensor<F>> {
        self.sensors.get_mut(side)?.get_mut(whisker)
    }

    /// Longest tick and missed deadlines.
    pub const fn timing(&self) -> &Timing {
        &self.timing
    }

    /// The same, for who takes them.
    pub const fn timing_mut(&mut self) -> &mut Timing {
        &mut self.timing
    }

    /// Carries out `command` for the whisker at `place`, between two ticks.
    ///
    /// # Errors
    /// [`NoActiveWhisker`] if there is none.
    pub fn command(&mut self, place: Place, command: Command<R>) -> Result<(), NoActiveWhisker>
    where
        M: MotorControl<R>,
    {
        self.motion.command(place, command)
    }

    /// Arms the motors of all whiskers, those that rest or were given up too, or keeps them
    /// off from the next tick on; all else goes on. A module starts with motors that are not
    /// armed. Whoever arms a motor that is off says that its whisker is at rest, unless it is
    /// homed.
    pub fn arm(&mut self, is_armed: bool)
    where
        M: MotorControl<R>,
    {
        self.motion.arm(is_armed);
    }
}

/// The normalised reading, (code − 8192)/8191 limited to −1: what
/// [`mlx90333::Word::normalised`] gives, within one rounding.
#[inline]
fn normalised<R: Real>(word: mlx90333::Word) -> R {
    // Limited as an integer, which costs less.
    R::from_code(word.signed14().max(-8191))
}

#[cfg(test)]
mod tests {
    use mlx90333::Word;

    #[test]
    fn every_code_is_normalised_as_the_driver_does() {
        for code in 0..1 << 14 {
            let word = Word::new(code << 2);
            let found: f32 = super::normalised(word);
            assert!((found - word.normalised()).abs() < 1.3e-7, "{code}");
        }
        assert_eq!(super::normalised::<f32>(Word::MID), 0.0);
    }
}
