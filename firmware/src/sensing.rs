//! From frames to readings, and what happens without good frames.

use mlx90333::{Decoder, FRAME_LEN, Word};

use crate::io::{BusError, FrameSource};
use crate::{Event, Place, SensorFault};

/// What one whisker's sensor reads in one tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reading {
    /// Deflection along the direction of whisking.
    pub x: Word,
    /// Deflection across it.
    pub y: Word,
    /// A new frame arrived in this tick; otherwise the last good one is held.
    pub fresh: bool,
    /// False while the whisker has a fault, of its sensor or of its motor: x and y
    /// are then at rest and the motor must be off.
    pub valid: bool,
}

impl Reading {
    pub(crate) const REST: Self = Self {
        x: Word::MID,
        y: Word::MID,
        fresh: false,
        valid: true,
    };

    /// Of a whisker with a fault.
    pub(crate) const FAULT: Self = Self {
        valid: false,
        ..Self::REST
    };
}

/// The health of a sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SensorHealth {
    /// It is trusted.
    Ok {
        /// Ticks without a good frame in succession, up to now.
        bad: u16,
    },
    /// Its readings cannot be used.
    Faulted {
        /// Ticks with a good frame in succession, up to now.
        good: u16,
    },
}

/// For how long readings are held, and how long a recovery takes, in ticks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct HoldLimits {
    /// Ticks without a good frame for which the last one is held.
    pub hold: u16,
    /// Good frames in succession before a faulty sensor is trusted again.
    pub recover: u16,
}

/// One whisker's sensor and its health.
#[derive(Debug)]
pub struct Sensor<F> {
    source: F,
    last: Reading,
    health: SensorHealth,
}

#[inline]
fn decode(
    decoder: Decoder,
    taken: Result<Option<[u8; FRAME_LEN]>, BusError>,
) -> Result<(Word, Word), SensorFault> {
    let bytes = taken
        .map_err(|_| SensorFault::Bus)?
        .ok_or(SensorFault::NoFrame)?;
    let frame = decoder.decode(&bytes).map_err(SensorFault::Frame)?;
    Ok((frame.first(), frame.second()))
}

impl<F: FrameSource> Sensor<F> {
    /// A sensor that has not been read yet.
    pub const fn new(source: F) -> Self {
        Self {
            source,
            last: Reading::REST,
            health: SensorHealth::Ok { bad: 0 },
        }
    }

    /// Where the frames come from.
    pub const fn source_mut(&mut self) -> &mut F {
        &mut self.source
    }

    /// Its health after the last tick.
    pub const fn health(&self) -> SensorHealth {
        self.health
    }

    /// Takes the frame of this tick. Without a good one the last good reading
    /// is held for `limits.hold` ticks; then the sensor counts as faulty until
    /// `limits.recover` good ones have come in succession.
    #[inline]
    pub fn read(
        &mut self,
        decoder: Decoder,
        limits: HoldLimits,
        place: Place,
        events: &mut impl FnMut(Event),
    ) -> Reading {
        match (decode(decoder, self.source.take()), self.health) {
            (Ok((x, y)), SensorHealth::Ok { .. }) => self.accept(x, y),
            (Ok((x, y)), SensorHealth::Faulted { good }) => {
                self.recover(good, limits, [x, y], place, events);
            }
            (Err(fault), health) => self.hold(health, limits, fault, place, events),
        }
        self.last
    }

    /// A good frame of a trusted sensor.
    #[inline]
    const fn accept(&mut self, x: Word, y: Word) {
        self.health = SensorHealth::Ok { bad: 0 };
        self.last = Reading {
            x,
            y,
            fresh: true,
            valid: true,
        };
    }

    /// A good frame of a faulty sensor, after `good` others.
    #[cold]
    #[inline(never)]
    fn recover(
        &mut self,
        good: u16,
        limits: HoldLimits,
        [x, y]: [Word; 2],
        place: Place,
        events: &mut impl FnMut(Event),
    ) {
        let good = good.saturating_add(1);
        if good >= limits.recover {
            self.accept(x, y);
            events(Event::SensorBack(place));
        } else {
            self.health = SensorHealth::Faulted { good };
        }
    }

    /// No good frame.
    #[cold]
    #[inline(never)]
    fn hold(
        &mut self,
        health: SensorHealth,
        limits: HoldLimits,
        fault: SensorFault,
        place: Place,
        events: &mut impl FnMut(Event),
    ) {
        self.health = match health {
            SensorHealth::Ok { bad } if bad < limits.hold => {
                self.last.fresh = false;
                SensorHealth::Ok { bad: bad + 1 }
            }
            SensorHealth::Ok { .. } => {
                self.last = Reading::FAULT;
                events(Event::SensorLost(place, fault));
                SensorHealth::Faulted { good: 0 }
            }
            SensorHealth::Faulted { .. } => SensorHealth::Faulted { good: 0 },
        };
    }
}

#[cfg(test)]
mod tests {
    use super::{HoldLimits, Reading, Sensor};
    use crate::io::{BusError, FrameSource};
    use crate::{Event, Place, SensorFault};
    use mlx90333::{Decoder, FRAME_LEN, Faults, FrameError, SumRule, Word, encode};

    const PLACE: Place = Place::new(1, 4);

    type Taken = Result<Option<[u8; FRAME_LEN]>, BusError>;

    struct Script<I>(I);

    impl<I: Iterator<Item = Taken>> FrameSource for Script<I> {
        fn take(&mut self) -> Result<Option<[u8; FRAME_LEN]>, BusError> {
            self.0.next().unwrap_or(Ok(None))
        }
    }

    /// A good frame with x at each of these words.
    fn good<const N: usize>(words: [u16; N]) -> [Taken; N] {
        words.map(|x| {
            let x = Word::new(x);
            Ok(Some(encode::alpha_beta(
                x,
                Word::MID,
                Faults::NONE,
                SumRule::SumB1B6,
            )))
        })
    }

    fn play(script: &[Taken]) -> (Vec<Reading>, Vec<(usize, Event)>) {
        let mut sensor = Sensor::new(Script(script.iter().copied()));
        let hold_limits = HoldLimits {
            hold: 3,
            recover: 2,
        };
        let mut events = Vec::new();
        let readings = (0..script.len())
            .map(|tick| {
                sensor.read(Decoder::new(), hold_limits, PLACE, &mut |e| {
                    events.push((tick, e));
                })
            })
            .collect();
        (readings, events)
    }

    #[test]
    fn a_short_gap_is_bridged_and_a_long_one_is_a_fault() {
        let bad = Ok(Some([0xFF; FRAME_LEN]));
        let [first, second] = good([0x9000, 0xA000]);
        let (readings, events) = play(&[first, bad, bad, bad, second, bad, bad, bad, bad, bad]);
        assert!(readings[..8].iter().all(|r| r.valid));
        assert_eq!(readings[3].x.raw(), 0x9000, "held");
        assert!(!readings[3].fresh && readings[4].fresh);
        let lost = Event::SensorLost(PLACE, SensorFault::Frame(FrameError::NoSensor));
        assert_eq!(events, [(8, lost)], "told once");
        assert_eq!(readings[8].x, Word::MID, "a faulty sensor feels nothing");
        assert!(!readings[9].valid);
    }

    #[test]
    fn recovery_needs_good_frames_in_a_row() {
        let bad = Err(BusError);
        let [one, two, three] = good([1, 2, 0x4000]);
        let (readings, events) = play(&[bad, bad, Ok(None), bad, one, bad, two, three, Ok(None)]);
        assert_eq!(
            events,
            [
                (3, Event::SensorLost(PLACE, SensorFault::Bus)),
                (7, Event::SensorBack(PLACE)),
            ]
        );
        assert!(!readings[6].valid && readings[7].valid && readings[8].valid);
        assert_eq!(readings[8].x.raw(), 0x4000);
    }

    #[test]
    fn fault_numbers_are_stable() {
        let numbers = [
            SensorFault::NoFrame,
            SensorFault::Bus,
            SensorFault::Frame(FrameError::NoSensor),
            SensorFault::Frame(FrameError::LineLow),
            SensorFault::Frame(FrameError::BadStart(1)),
            SensorFault::Frame(FrameError::BadSum {
                expected: 1,
                found: 2,
            }),
            SensorFault::Frame(FrameError::Sensor(Faults::FIELD_TOO_LOW)),
        ]
        .map(SensorFault::code);
        assert_eq!(numbers, [16, 17, 18, 19, 20, 21, 22]);
    }
}
