//! What is drawn, taken from the history at once, so that nothing is drawn while it is held.

use firmware::{Event, EventRecord, Place};
use host_sim::{decisions, report};
use wire::{Flags, TickRecord};

use super::history::{History, Said, by, until};
use super::looking::Hair;
use super::view::{Extent, Shows, View};
use crate::faults::{Fault, fault, number};
use crate::sample::Sample;
use crate::tally::{self, SIDES};

const PARTS: usize = 160;
const MOST_LINES: usize = 60;
const MOST_FAULTS: usize = 8;

/// Signals of a whisker, in the order of [`signals`].
pub(crate) const SIGNALS: usize = 7;

#[derive(Debug, Clone)]
pub(crate) struct Shown {
    pub(crate) title: String,
    pub(crate) from_s: f64,
    pub(crate) to_s: f64,
    /// How far the picture is behind what comes, s; none: it is not held.
    pub(crate) behind_s: Option<f64>,
    pub(crate) has_help: bool,
    pub(crate) whiskers: Vec<Whisker>,
    /// All whiskers of the head, where that is looked at.
    pub(crate) hairs: Vec<Hair>,
    pub(crate) events: Vec<String>,
    /// Faults, the newest first, and how many there were.
    pub(crate) faults: Vec<Fault>,
    pub(crate) fault_count: usize,
    /// How the ticks keep their time, and what was lost.
    pub(crate) load: Vec<String>,
    /// Where the PC's classifier stands.
    pub(crate) classifying: Vec<String>,
    pub(crate) message: String,
}

#[derive(Debug, Clone)]
pub(crate) struct Whisker {
    pub(crate) side: &'static str,
    pub(crate) record: Option<TickRecord>,
    /// Least and most of each signal in each part of the time: s, value.
    pub(crate) curves: [Vec<(f64, f64)>; SIGNALS],
    pub(crate) posteriors: Vec<(String, f32)>,
}

pub(crate) fn signals(record: &TickRecord) -> [f64; SIGNALS] {
    let sample = Sample::new(record, 0.0);
    let [x, y] = sample.codes.map(f64::from);
    [
        sample.setpoint_deg,
        sample.measured_deg,
        x,
        y,
        sample.contact,
        sample.z,
        sample.duty,
    ]
}

impl History {
    pub(crate) fn extent(&self) -> Extent {
        Extent {
            oldest: self.oldest(),
            now: self.now(),
            tick_hz: self.tick_hz,
            whiskers: self.whiskers,
            has_head: !self.hairs.is_empty(),
        }
    }

    pub(crate) fn shown(&self, view: &View, title: &str, message: String) -> Shown {
        let hz = f64::from(self.tick_hz);
        let extent = self.extent();
        let end = view.end(extent);
        let from = end.saturating_sub(self.ticks_of(view.span_s()));
        let events = || until(&self.events, end).map(|said| &said.what);
        let lines = events().rev().filter_map(|event| self.line(event));
        let mut lines: Vec<_> = lines.take(MOST_LINES).collect();
        lines.reverse();
        let faults = events().rev();
        let faults = faults.filter_map(|event| fault(event, self.tick_hz));
        let whiskers = view.sides().iter();
        Shown {
            title: title.to_owned(),
            from_s: end as f64 / hz - view.span_s(),
            to_s: end as f64 / hz,
            behind_s: view.held.map(|_| (self.now() - end) as f64 / hz),
            has_help: view.has_help,
            whiskers: whiskers
                .map(|side| self.whisker(*side, from, end))
                .collect(),
            hairs: match view.shows {
                Shows::Head => by(&self.hairs, end).map_or(Vec::new(), |seen| seen.what.clone()),
                Shows::Left | Shows::Right | Shows::Both => Vec::new(),
            },
            events: lines,
            fault_count: events().filter_map(|of| number(&of.event)).count(),
            faults: faults.take(MOST_FAULTS).collect(),
            load: self.load(),
            classifying: self.classifying(view, end),
            message,
        }
    }

    fn line(&self, EventRecord { sequence, event }: &EventRecord) -> Option<String> {
        let t_s = f64::from(*sequence) / f64::from(self.tick_hz);
        let of = |place: &Place| match self.whiskers {
            1 => String::new(),
            _ => format!("{} ", place.side_name()),
        };
        Some(match event {
            Event::Touch { place, number } => format!("{t_s:8.3} {}touch {number}", of(place)),
            Event::TouchEnd { place, number } => format!("{t_s:8.3} {}  {number} ends", of(place)),
            Event::Decision(place, decision) => {
                let said = decisions::stated(*decision, &self.module_classes);
                format!("{t_s:8.3} {}{said} {}", of(place), decision.samples())
            }
            Event::Pose(place, pose) => {
                format!("{t_s:8.3} {}  {}", of(place), decisions::stands(*pose))
            }
            Event::Node(..) => {
                let (_, said) = report::said(event, &[])?;
                format!("{t_s:8.3} {said}")
            }
            _ => return None,
        })
    }

    fn whisker(&self, side: usize, from: u64, end: u64) -> Whisker {
        let hz = f64::from(self.tick_hz);
        let mut curves: [Vec<(f64, f64)>; SIGNALS] = Default::default();
        let ticks = ((end - from) / PARTS as u64).max(1);
        let part_of = |entry: &Said<TickRecord>| entry.ticks / ticks;
        let entries: Vec<&Said<TickRecord>> = self.between(side, from, end).collect();
        for part in entries.chunk_by(|one, next| part_of(one) == part_of(next)) {
            let mut ends = [[f64::INFINITY, f64::NEG_INFINITY]; SIGNALS];
            for entry in part {
                for ([least, most], value) in ends.iter_mut().zip(signals(&entry.what)) {
                    (*least, *most) = (least.min(value), most.max(value));
                }
            }
            let at_s = (part_of(part[0]) as f64 + 0.5) * ticks as f64 / hz;
            for (curve, ends) in curves.iter_mut().zip(ends) {
                curve.extend(ends.map(|value| (at_s, value)));
            }
        }
        let record = entries.last().map(|entry| entry.what);
        let posteriors = by(&self.beliefs[side], end).map_or(&[][..], |belief| &belief.what);
        let classes = self.classes().iter().cloned();
        Whisker {
            side: SIDES[record.as_ref().map_or(side, tally::side)],
            record,
            curves,
            posteriors: classes.zip(posteriors.iter().copied()).collect(),
        }
    }

    fn load(&self) -> Vec<String> {
        let mut load = vec!["longest tick: unknown".to_owned()];
        if let Some(health) = self.health {
            let longest_us = f64::from(health.worst_tenths) / 10.0;
            let share = longest_us * f64::from(self.tick_hz) / 1e4;
            let (missed, dropped) = (health.missed, health.dropped);
            load[0] = format!("longest tick {longest_us:.1} us ({share:.0} %)");
            load.push(format!("ticks missed {missed}, events dropped {dropped}"));
        }
        let (records, lost) = (self.tally.records, self.tally.lost);
        load.push(format!("records {records}, lost {lost}"));
        if self.tally.restarts > 0 {
            load.push(format!("starts meanwhile {}", self.tally.restarts));
        }
        load
    }

    fn classifying(&self, view: &View, end: u64) -> Vec<String> {
        if self.classes().is_empty() {
            return vec!["no model: --model FILE names one".to_owned()];
        }
        let mut lines = vec!["computed on the PC from records".to_owned()];
        let hz = f64::from(self.tick_hz);
        for side in view.sides() {
            if let Some(said) = by(&self.decided[*side], end) {
                let at_s = said.ticks as f64 / hz;
                let stated = decisions::stated(said.what, self.classes());
                lines.push(format!("{stated} at {at_s:.3} s"));
            }
        }
        let [all, same] = self.agreed;
        lines.push(format!("with the module: {same} of {all}"));
        if let Some(restarted) = &self.restarted {
            let at_s = restarted.ticks as f64 / hz;
            lines.push(format!("again from {at_s:.1} s: {}", restarted.what));
        }
        lines
    }
}

pub(crate) const STATES: [(&str, Flags); 6] = [
    ("armed", Flags::ARMED),
    ("running", Flags::RUNNING),
    ("homing", Flags::HOMING),
    ("resting", Flags::RESTING),
    ("touching", Flags::TOUCHING),
    ("valid", Flags::VALID),
];

impl Shown {
    /// What is shown before a key is pressed.
    pub(crate) fn first(history: &History, title: &str) -> Self {
        history.shown(&View::new(history.extent()), title, String::new())
    }
}

#[cfg(test)]
mod tests;
