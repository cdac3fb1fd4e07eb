//! The module's classifier on this PC, over the records: a module reports its decisions, but not
//! its posteriors meanwhile.
//!
//! Contact is computed again from the sensor's words, by the module's own filter. The contact of
//! a record has 13 bits: now and then a sample near the least contact would count on one side
//! only, and the decisions would differ. Numbers are `f32`, as on a board with an FPU.

use firmware::design_parameters::{Plausible, sensor_limits};
use firmware::{Event, Perception, Place, Reading, Sensed, SensorLimits};
use host_sim::Error;
use host_sim::classifier::{Codes, posteriors};
use mlx90333::Word;
use tactile::Decision;
use whisking::{Real, filter};
use wire::{Flags, TickRecord};

use super::known::Known;
use crate::tally::{Before, SIDES, side};

/// Ticks at a module's start by which a record is asked for, where one listens from the start.
const UNSEEN: u32 = 100;

#[derive(Debug, Clone, Copy, Default)]
struct Track {
    filter: filter::State<f32>,
    words: [u16; 2],
    /// Frames that have repeated these words in succession.
    repeats: u16,
    /// Its motor rested or was homed after the last tick.
    rests: bool,
}

impl Track {
    /// Contact and reading of a tick, as the module has them.
    fn follow(
        &mut self,
        record: &TickRecord,
        h50: &filter::Config<f32>,
        limits: SensorLimits,
    ) -> (f32, Reading) {
        let has = |flag| record.flags.contains(flag);
        let words = [record.x, record.y];
        if has(Flags::FRESH) {
            let is_same = std::mem::replace(&mut self.words, words) == words;
            self.repeats = if is_same {
                self.repeats.saturating_add(1)
            } else {
                0
            };
        }
        let has_rested =
            std::mem::replace(&mut self.rests, has(Flags::RESTING) || has(Flags::HOMING));
        let [x, y] = words.map(Word::new);
        let reading = Reading {
            x,
            y,
            fresh: has(Flags::FRESH),
            current: self.repeats <= limits.stale,
            valid: has(Flags::VALID) && !has_rested,
        };
        if !reading.valid {
            self.filter = filter::State::default();
            return (0.0, reading);
        }
        let deflection = f32::from_code(x.signed14().max(-8191));
        (h50.process(&mut self.filter, deflection).abs(), reading)
    }
}

/// Classifies what the first whisker of each side feels.
pub(crate) struct Listener {
    perception: Option<Perception<Codes>>,
    classes: Vec<String>,
    least: Option<f32>,
    h50: filter::Config<f32>,
    limits: SensorLimits,
    tracks: [Track; 2],
    /// How many whiskers a tick has records of, and those of the tick that have come.
    whiskers: usize,
    pending: [Option<TickRecord>; 2],
    /// Side and decision of what fell in the tick.
    decided: Vec<(usize, Decision)>,
    has_begun: bool,
}

impl Listener {
    pub(crate) fn new(known: Known, tick_hz: u32, whiskers: usize) -> Result<Self, Error> {
        let h50 = filter::Config::new(filter::CORNER_HZ, f64::from(tick_hz));
        let h50 = h50.map_err(|error| Error::Work(format!("{tick_hz} ticks a second: {error}")))?;
        let plausible = Plausible {
            frozen_s: known.frozen_s,
            jump_per_s: f64::INFINITY,
        };
        Ok(Self {
            classes: known.classifier.classes().to_vec(),
            perception: Some(Perception::new(
                known.classifier.into_codes(),
                SIDES.len(),
                tick_hz,
            )),
            least: known.contact_min.map(|least| least as f32),
            h50,
            limits: sensor_limits(tick_hz, plausible),
            tracks: [Track::default(); 2],
            whiskers: whiskers.clamp(1, 2),
            pending: [None; 2],
            decided: Vec::new(),
            has_begun: false,
        })
    }

    pub(crate) fn classes(&self) -> &[String] {
        &self.classes
    }

    pub(crate) fn posteriors(&self, side: usize) -> Vec<f32> {
        let Some(perception) = &self.perception else {
            return Vec::new();
        };
        let posteriors = posteriors(perception.classifier(), side);
        posteriors.to_f64().map(|p| p as f32).collect()
    }

    /// Side and decision of what falls with it. Restarts after lost records or another start of the
    /// module.
    pub(crate) fn take(&mut self, record: &TickRecord, before: Before) -> Vec<(usize, Decision)> {
        if before != Before::Nothing {
            self.perception = self.perception.take().map(Perception::restarted);
            self.pending = [None; 2];
            self.tracks = [Track::default(); 2];
        }
        if !std::mem::replace(&mut self.has_begun, true) && record.sequence <= UNSEEN {
            self.catch_up(record.sequence);
        }
        let other = self.pending[1 - side(record)];
        if other.is_some_and(|other| other.sequence != record.sequence) {
            // The first tick may come in part.
            self.pending = [None; 2];
        }
        self.pending[side(record)] = Some(*record);
        match (self.whiskers, self.pending) {
            (1, _) => {
                self.pending = [None; 2];
                self.step([record]);
            }
            (_, [Some(left), Some(right)]) => {
                self.pending = [None; 2];
                self.step([&left, &right]);
            }
            _ => {}
        }
        std::mem::take(&mut self.decided)
    }

    /// Before a record could be asked for there were ticks: all were at rest, or nearly.
    fn catch_up(&mut self, sequence: u32) {
        let rest = |flags| TickRecord {
            x: Word::MID.raw(),
            y: Word::MID.raw(),
            flags: flags | Flags::VALID,
            ..TickRecord::default()
        };
        let (left, right) = (rest(Flags::default()), rest(Flags::RIGHT));
        for _ in 1..sequence {
            if self.whiskers == 1 {
                self.step([&left]);
            } else {
                self.step([&left, &right]);
            }
        }
    }

    fn step<const S: usize>(&mut self, records: [&TickRecord; S]) {
        let Some(perception) = &mut self.perception else {
            return;
        };
        for (n, (track, record)) in self.tracks.iter_mut().zip(records).enumerate() {
            let (contact, reading) = track.follow(record, &self.h50, self.limits);
            let sensed = Sensed {
                place: Place::new(n as u8, 0),
                reading,
                contact,
                least: self.least,
                says_pose: false,
            };
            perception.step(n, sensed, &mut |event| {
                if let Event::Decision(place, decision) = event {
                    self.decided.push((place.side.into(), decision));
                }
            });
        }
    }
}

#[cfg(test)]
mod tests;
