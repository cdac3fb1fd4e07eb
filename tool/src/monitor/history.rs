//! What a module has said in the last minutes.

use std::collections::{VecDeque, vec_deque};

use firmware::{Event, EventRecord, Health, Packet};
use tactile::Decision;
use wire::{Answer, Flags, TickRecord};

use super::listener::Listener;
use super::looking::Hair;
use crate::source::Incoming;
use crate::tally::{Before, Tally, TickCount, side};

/// For how long records are held, s.
pub(crate) const HELD_S: u32 = 300;

/// How many lines of the log are held, and how many events.
const LINES: usize = 4000;
/// How often the classifier's posteriors are kept in a second, and the whiskers of a head looked at:
/// as often as a picture is drawn.
const BELIEFS_HZ: u32 = 20;
pub(crate) const LOOKS_HZ: u32 = 20;

/// Something that was said, and the tick by then: counted on where the module starts again.
#[derive(Debug, Clone)]
pub(crate) struct Said<T> {
    pub(crate) ticks: u64,
    pub(crate) what: T,
}

#[derive(Default)]
pub(crate) struct History {
    pub(crate) tick_hz: u32,
    /// How many of its whiskers are watched: 1, or one a side.
    pub(crate) whiskers: usize,
    pub(crate) tally: Tally,
    pub(crate) sides: [VecDeque<Said<TickRecord>>; 2],
    pub(crate) lines: VecDeque<Said<String>>,
    pub(crate) events: VecDeque<Said<EventRecord>>,
    pub(crate) module_classes: Vec<String>,
    /// How sure the PC's classifier was of each class, and what it decided.
    pub(crate) beliefs: [VecDeque<Said<Vec<f32>>>; 2],
    pub(crate) decided: [VecDeque<Said<Decision>>; 2],
    pub(crate) health: Option<Health>,
    /// Ticks in which the module decided, and in how many of them so did the PC.
    pub(crate) agreed: [u64; 2],
    /// When the PC's classifier restarted last, and why.
    pub(crate) restarted: Option<Said<&'static str>>,
    listener: Option<Listener>,
    ticks: TickCount,
    /// Whether module and PC have decided in the tick that is under way.
    deciding: [bool; 2],
    last_belief: u64,
    /// All whiskers of a head.
    pub(crate) hairs: VecDeque<Said<Vec<Hair>>>,
}

impl History {
    /// Of a module that sends records of every tick, or of every so many.
    pub(crate) fn new(
        (tick_hz, every): (u32, u32),
        whiskers: usize,
        listener: Option<Listener>,
    ) -> Self {
        Self {
            tick_hz,
            whiskers: whiskers.clamp(1, 2),
            tally: Tally::of_every(every),
            listener,
            ..Self::default()
        }
    }

    pub(crate) const fn now(&self) -> u64 {
        self.ticks.now()
    }

    pub(crate) fn oldest(&self) -> u64 {
        let firsts = self.sides.iter().filter_map(VecDeque::front);
        firsts.map(|entry| entry.ticks).min().unwrap_or(0)
    }

    pub(crate) fn ticks_of(&self, seconds: f64) -> u64 {
        (seconds * f64::from(self.tick_hz)) as u64
    }

    pub(crate) fn classes(&self) -> &[String] {
        self.listener.as_ref().map_or(&[], Listener::classes)
    }

    pub(crate) fn take(&mut self, incoming: &Incoming) -> Vec<Answer> {
        let mut answers = Vec::new();
        if incoming.has_restarted {
            self.tally.restart();
            self.ticks.restart();
        }
        for packet in &incoming.packets {
            match packet {
                Packet::Record(record) => self.record(record),
                Packet::Answer(answer) => answers.push(*answer),
                Packet::Event(EventRecord {
                    event: Event::Health(health),
                    ..
                }) => self.health = Some(*health),
                Packet::Event(event) => say(&mut self.events, self.ticks.now(), *event),
            }
        }
        for line in &incoming.lines {
            say(&mut self.lines, self.ticks.now(), line.clone());
        }
        answers
    }

    /// Keeps how all whiskers of a head are by now, if there is one.
    pub(crate) fn see(&mut self, hairs: Vec<Hair>) {
        if hairs.is_empty() {
            return;
        }
        let ticks = self.now();
        self.hairs.push_back(Said { ticks, what: hairs });
        bound(&mut self.hairs, (HELD_S * LOOKS_HZ) as usize);
    }

    fn record(&mut self, record: &TickRecord) {
        let last = self.now();
        let before = self.tally.take(record);
        let ticks = self.ticks.take(record.sequence);
        if ticks != last {
            let [module, here] = std::mem::take(&mut self.deciding);
            self.agreed[0] += u64::from(module);
            self.agreed[1] += u64::from(module && here);
        }
        // A board of a head may have one of the right.
        let side = if self.whiskers == 1 { 0 } else { side(record) };
        let entries = &mut self.sides[side];
        let what = *record;
        entries.push_back(Said { ticks, what });
        let held = u64::from(HELD_S) * u64::from(self.tick_hz);
        let is_old = |first: &mut Said<_>| first.ticks + held < ticks;
        while entries.pop_front_if(is_old).is_some() {}
        self.listen(record, before, ticks);
    }

    fn listen(&mut self, record: &TickRecord, before: Before, ticks: u64) {
        let Some(listener) = &mut self.listener else {
            return;
        };
        let why = match before {
            Before::Nothing => None,
            Before::Lost(_) => Some("records were lost"),
            Before::Restart => Some("the module started again"),
        };
        if let Some(what) = why {
            self.restarted = Some(Said { ticks, what });
        }
        self.deciding[0] |= record.flags.contains(Flags::DECIDED);
        let decided = listener.take(record, before);
        self.deciding[1] |= !decided.is_empty();
        let is_due = ticks >= self.last_belief + u64::from((self.tick_hz / BELIEFS_HZ).max(1));
        if is_due || !decided.is_empty() {
            self.last_belief = ticks;
            for (side, beliefs) in self.beliefs.iter_mut().enumerate().take(self.whiskers) {
                let what = listener.posteriors(side);
                beliefs.push_back(Said { ticks, what });
                bound(beliefs, (HELD_S * BELIEFS_HZ) as usize);
            }
        }
        for (side, decision) in decided {
            say(&mut self.decided[side.min(1)], ticks, decision);
        }
    }

    /// What is held of a side from `from` on, up to and with `to`.
    pub(crate) fn between(
        &self,
        side: usize,
        from: u64,
        to: u64,
    ) -> vec_deque::Iter<'_, Said<TickRecord>> {
        let entries = &self.sides[side.min(1)];
        let first = entries.partition_point(|entry| entry.ticks < from);
        let last = entries.partition_point(|entry| entry.ticks <= to);
        entries.range(first..last.max(first))
    }
}

pub(crate) fn until<T>(said: &VecDeque<Said<T>>, end: u64) -> vec_deque::Iter<'_, Said<T>> {
    let after = said.partition_point(|said| said.ticks <= end);
    said.range(..after)
}

pub(crate) fn by<T>(said: &VecDeque<Said<T>>, end: u64) -> Option<&Said<T>> {
    until(said, end).next_back()
}

fn say<T>(all: &mut VecDeque<Said<T>>, ticks: u64, what: T) {
    all.push_back(Said { ticks, what });
    bound(all, LINES);
}

fn bound<T>(all: &mut VecDeque<T>, most: usize) {
    while all.len() > most {
        all.pop_front();
    }
}

#[cfg(test)]
mod tests {
    use firmware::Packet;
    use wire::Flags;

    use super::{HELD_S, History};
    use crate::source::{Incoming, record};

    fn incoming(sequence: u32, flags: Flags) -> Incoming {
        Incoming::of([Packet::Record(record(sequence, flags))])
    }

    #[test]
    fn minutes_are_held_and_no_more() {
        let mut history = History::new((10, 1), 2, None);
        let last = 2 * HELD_S * 10;
        for sequence in 1..=last {
            history.take(&incoming(sequence, Flags::default()));
            history.take(&incoming(sequence, Flags::RIGHT));
        }
        assert_eq!(history.now(), u64::from(last));
        assert_eq!(history.oldest(), u64::from(last - 10 * HELD_S));
        let found: Vec<u64> = history.between(1, 5990, 5993).map(|e| e.ticks).collect();
        assert_eq!(found, [5990, 5991, 5992, 5993]);
        assert_eq!(history.between(0, 7, 3).count(), 0);
        assert_eq!(history.between(0, 9000, 8000).count(), 0);
    }
}
