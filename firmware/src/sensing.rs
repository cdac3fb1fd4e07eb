//! From frames to readings, and what happens without good frames.

mod limits;
mod plausible;
mod swing;

use mlx90333::{Decoder, FRAME_LEN, FrameError, Word};

use crate::config::Part;
use crate::io::WordSource;
use crate::zero::{Zero, ZeroLimits};
use crate::{Event, Place, SensorFault};
pub use limits::{BAD_WEIGHT, SensorLimits};
use plausible::Course;
pub(crate) use swing::Swing;
pub use swing::SwingLimits;

/// What one whisker's sensor reads in one tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reading {
    /// Deflection along the direction of whisking.
    pub x: Word,
    /// Deflection across it.
    pub y: Word,
    /// A new frame arrived in this tick; otherwise the last good one is held.
    pub fresh: bool,
    /// The words have changed within the time for which readings are held. If not, they
    /// may be frozen: they still are the best there is to move by, but no evidence.
    pub current: bool,
    /// False while the whisker has a fault, of its sensor or of its motor: x and y
    /// are then at rest and the motor must be off.
    pub valid: bool,
}

impl Reading {
    pub(crate) const REST: Self = Self {
        x: Word::MID,
        y: Word::MID,
        fresh: false,
        current: true,
        valid: true,
    };

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

/// One whisker's sensor and its health.
#[derive(Debug)]
pub struct Sensor<F> {
    source: F,
    /// Where it is found.
    zero: Option<Zero>,
    last: Reading,
    health: SensorHealth,
    course: Course,
    /// Ticks left in which no frame is begun.
    rest: u16,
    /// How near bad ticks are to [`SensorLimits::burst`].
    burst: u16,
    why: SensorFault,
}

impl<F: WordSource> Sensor<F> {
    /// A sensor that has not been read yet, and whose zero is found or is mid-scale.
    pub fn new(source: F, finds_zero: bool) -> Self {
        Self {
            source,
            zero: finds_zero.then(Zero::default),
            last: Reading::REST,
            health: SensorHealth::Ok { bad: 0 },
            course: Course::UNKNOWN,
            rest: 0,
            burst: 0,
            why: SensorFault::NoFrame,
        }
    }

    /// Where the words come from.
    pub const fn source_mut(&mut self) -> &mut F {
        &mut self.source
    }

    /// The last frame as it came, where there are frames.
    pub fn last(&self) -> Option<[u8; FRAME_LEN]> {
        self.source.last()
    }

    /// The zero that is taken out of its words, where it is found.
    pub fn zero(&self) -> Option<&Zero> {
        self.zero.as_ref().filter(|_| Part::Zero.is_built())
    }

    /// What it read in the last tick.
    pub const fn reading(&self) -> Reading {
        self.last
    }

    /// Its health after the last tick.
    pub const fn health(&self) -> SensorHealth {
        self.health
    }

    /// Takes the frame of this tick, and begins the next. Without a good one the last
    /// good reading is held for `limits.hold` ticks, or less if that happens too often;
    /// then the sensor counts as faulty until `limits.recover` good ones have come in
    /// succession. Words that repeat for `limits.frozen` ticks are a fault at once.
    #[inline]
    pub fn read(
        &mut self,
        decoder: Decoder,
        limits: &SensorLimits,
        place: Place,
        events: &mut impl FnMut(Event),
    ) -> Reading {
        let read = self.next(decoder, limits.resync);
        let judged = read.and_then(|words| self.course.follow(words, limits));
        let is_accepted = match (judged, self.health) {
            (Ok(()), SensorHealth::Ok { .. }) => {
                self.burst = self.burst.saturating_sub(1);
                true
            }
            (Ok(()), SensorHealth::Faulted { good }) => self.recover(good, limits, place, events),
            (Err(fault), health) => {
                self.hold(health, limits, fault, place, events);
                false
            }
        };
        if is_accepted {
            self.accept(limits);
        }
        self.last
    }

    /// Starts the next frame, too: after one that was refused, `resync` ticks later.
    #[inline]
    fn next(&mut self, decoder: Decoder, resync: u16) -> Result<[Word; 2], SensorFault> {
        let mut read = Err(SensorFault::NoFrame);
        if self.rest == 0 {
            read = self.source.words(decoder);
            if let Err(SensorFault::Bus | SensorFault::Frame(_)) = read {
                self.rest = resync;
            }
        } else {
            self.rest -= 1;
        }
        if self.rest == 0 {
            self.source.begin();
        }
        read
    }

    #[inline]
    fn accept(&mut self, limits: &SensorLimits) {
        self.health = SensorHealth::Ok { bad: 0 };
        let words = self.course.words;
        let [x, y] = self.zero().map_or(words, |zero| zero.out_of(words));
        self.last = Reading {
            x,
            y,
            fresh: true,
            current: self.course.repeats <= limits.stale,
            valid: true,
        };
    }

    /// After [`read`](Self::read) and what was felt by it: follows the zero, where that is found
    /// by itself, and whether the whisker `is_calm` is asked. Gives the codes by which it has moved.
    #[inline]
    pub fn follow_zero(
        &mut self,
        is_calm: bool,
        limits: ZeroLimits,
        place: Place,
        events: &mut impl FnMut(Event),
    ) -> Option<[i16; 2]> {
        let Reading { x, y, valid, .. } = self.last;
        let zero = self.zero.as_mut().filter(|_| valid)?;
        let [x_before, y_before] = zero.codes();
        let [x, y] = zero.follow([x, y], is_calm, limits)?;
        events(Event::ZeroMoved(place, [x, y]));
        Some([x.saturating_sub(x_before), y.saturating_sub(y_before)])
    }

    /// A good frame of a faulty sensor, after `good` others; whether it ends the fault.
    #[cold]
    #[inline(never)]
    fn recover(
        &mut self,
        good: u16,
        limits: &SensorLimits,
        place: Place,
        events: &mut impl FnMut(Event),
    ) -> bool {
        let good = good.saturating_add(1);
        if self.course.repeats > limits.stale {
            self.health = SensorHealth::Faulted { good: 0 };
        } else if good >= limits.recover {
            self.burst = 0;
            events(Event::SensorBack(place));
            return true;
        } else {
            self.health = SensorHealth::Faulted { good };
        }
        false
    }

    #[cold]
    #[inline(never)]
    fn hold(
        &mut self,
        health: SensorHealth,
        limits: &SensorLimits,
        fault: SensorFault,
        place: Place,
        events: &mut impl FnMut(Event),
    ) {
        self.course.miss();
        let SensorHealth::Ok { bad } = health else {
            self.health = SensorHealth::Faulted { good: 0 };
            return;
        };
        // A tick without a frame follows from one with a bad frame, if there was one; and a sensor that
        // has reported an error starts again, which takes it 16 ms of silence (its sister's data
        // sheet, MLX90316 revision 10, sections 16.7 and 16.9).
        let follows = match fault {
            SensorFault::NoFrame => true,
            SensorFault::Frame(FrameError::NoSensor) => {
                matches!(self.why, SensorFault::Frame(FrameError::Sensor(_)))
            }
            _ => false,
        };
        if bad == 0 || !follows {
            self.why = fault;
        }
        self.burst = self.burst.saturating_add(BAD_WEIGHT);
        let fault = match self.why {
            SensorFault::Frozen => SensorFault::Frozen,
            why if bad >= limits.hold => why,
            _ if self.burst <= limits.burst => {
                self.last.fresh = false;
                self.health = SensorHealth::Ok { bad: bad + 1 };
                return;
            }
            SensorFault::Jump => SensorFault::Jump,
            why => SensorFault::Often(why.code()),
        };
        self.last = Reading::FAULT;
        self.health = SensorHealth::Faulted { good: 0 };
        events(Event::SensorLost(place, fault));
        self.show(place, events);
    }

    /// Shows the last frame where that says more than its fault: all ones and all zeros do not.
    fn show(&self, place: Place, events: &mut impl FnMut(Event)) {
        match self.why {
            SensorFault::Frame(FrameError::NoSensor | FrameError::LineLow) => {}
            SensorFault::Frame(_) => {
                // All ones follow a report.
                let last = self.source.last();
                if let Some(bytes) = last.filter(|bytes| *bytes != [u8::MAX; FRAME_LEN]) {
                    events(Event::Frame(place, bytes));
                }
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests;
