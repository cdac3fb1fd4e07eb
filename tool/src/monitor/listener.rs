//! The module's classifier on this PC, over the records: a module reports its decisions, but not
//! its posteriors meanwhile.
//!
//! Contact is computed again from the sensor's words, by the module's own filter. The contact of
//! a record has 13 bits: now and then a sample near the least contact would count on one side
//! only, and the decisions would differ. Numbers are `f32`, as on a board with an FPU.

use std::path::Path;

use firmware::design_parameters::{Plausible, sensor_limits};
use firmware::{ClassifierConfig, Event, Perception, Place, Reading, SensorLimits};
use host_sim::classifier::{Classifier, Codes, posteriors};
use host_sim::loaded::Loaded;
use host_sim::{Error, files};
use mlx90333::Word;
use scene::Rule;
use tactile::{Deciding, Decision};
use whisking::{Real, filter};
use wire::{Flags, TickRecord};

use crate::tally::{Before, SIDES, side};

/// Ticks at a module's start by which a record is asked for, where one listens from the start.
const UNSEEN: u32 = 100;

/// How sure a classifier must be where no scene says it.
const RULE: Rule = Rule::Sequential { threshold: 0.99 };

/// A classifier, and what it takes for a sample.
#[derive(Debug, Clone)]
pub(crate) struct Known {
    pub(crate) classifier: Classifier,
    pub(crate) contact_min: Option<f64>,
    /// For how long a sensor's words may repeat, s.
    pub(crate) frozen_s: f64,
}

impl Known {
    /// That of a scene, with another model or its own; none without either.
    pub(crate) fn of(scene: Option<&Path>, model: Option<&Path>) -> Result<Option<Self>, Error> {
        let loaded = scene.map(Loaded::new).transpose()?;
        let said = loaded.as_ref().map(|of| &of.scene);
        let said = said.filter(|scene| scene.classifier.is_some());
        let classifier = match (model, &loaded) {
            (Some(path), _) => {
                let (_, model) = files::load_model(path)?;
                let classifier = match said {
                    Some(scene) => Classifier::of_scene(model, scene),
                    None => Classifier::new(model, RULE),
                };
                Some(classifier.map_err(|fault| Error::file(path, fault))?)
            }
            (None, Some(loaded)) => loaded.classifier()?,
            (None, None) => None,
        };
        let Some(classifier) = classifier else {
            return Ok(None);
        };
        let gate = classifier.touch_rule().map(|touch| touch.gate);
        let contact_min = match &loaded {
            Some(loaded) => config::contact_min(&loaded.scene, gate)
                .map_err(|fault| Error::Input(fault.to_string()))?,
            None => gate.map(f64::from),
        };
        let frozen_s = loaded.map_or(f64::INFINITY, |loaded| loaded.scene.sensor.frozen_s);
        Ok(Some(Self {
            classifier,
            contact_min,
            frozen_s,
        }))
    }
}

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
            self.repeats = match std::mem::replace(&mut self.words, words) {
                before if before == words => self.repeats.saturating_add(1),
                _ => 0,
            };
        }
        let rests = has(Flags::RESTING) || has(Flags::HOMING);
        let has_rested = std::mem::replace(&mut self.rests, rests);
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
    /// What a listener needs of it: from what contact samples count.
    config: ClassifierConfig<f32>,
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
        let classes = known.classifier.classes().to_vec();
        let codes = known.classifier.into_codes();
        Ok(Self {
            classes,
            perception: Some(Perception::new(codes, SIDES.len(), tick_hz)),
            config: ClassifierConfig {
                rule: None,
                deciding: Deciding::Each,
                contact_min: known.contact_min.map(|least| least as f32),
                says_pose: false,
            },
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
        let is_older = |other: &TickRecord| other.sequence != record.sequence;
        if self.pending.iter().flatten().any(is_older) {
            // The first tick may come in part.
            self.pending = [None; 2];
        }
        self.pending[side(record)] = Some(*record);
        let records: Vec<TickRecord> = self.pending.iter().flatten().copied().collect();
        if records.len() >= self.whiskers {
            self.pending = [None; 2];
            self.step(&records);
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
        let both = [Flags::default(), Flags::RIGHT].map(rest);
        for _ in 1..sequence {
            self.step(&both[..self.whiskers]);
        }
    }

    fn step(&mut self, records: &[TickRecord]) {
        let Some(perception) = &mut self.perception else {
            return;
        };
        for (n, (track, record)) in self.tracks.iter_mut().zip(records).enumerate() {
            let (contact, reading) = track.follow(record, &self.h50, self.limits);
            let whisker = (n, Place::new(n as u8, 0));
            perception.step(whisker, (reading, contact), &self.config, &mut |event| {
                if let Event::Decision(place, decision) = event {
                    self.decided.push((place.side.into(), decision));
                }
            });
        }
    }
}

#[cfg(test)]
mod tests;
