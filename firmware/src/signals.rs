//! What two pins show of a module: contact, and that a decision fell.

use crate::{Event, Place};

/// What the pins show.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Signals {
    /// A whisker touches something, a bit for each.
    touching: u32,
    /// When the pin of decisions was raised, ticks.
    decided: Option<u32>,
}

impl Signals {
    /// Neither.
    pub const fn new() -> Self {
        Self {
            touching: 0,
            decided: None,
        }
    }

    /// Notes an event of the tick that is the `now`-th.
    pub fn note(&mut self, event: &Event, now: u32) {
        let bit =
            |place: &Place| 1_u32 << ((u32::from(place.side) * 16 + u32::from(place.whisker)) % 32);
        match event {
            Event::Touch { place, .. } => self.touching |= bit(place),
            Event::TouchEnd { place, .. } => self.touching &= !bit(place),
            Event::Decision(..) => self.decided = Some(now),
            _ => {}
        }
    }

    /// Levels of contact and of decisions at the tick that is the `now`-th, of which so many
    /// are a pulse.
    pub fn levels(&mut self, now: u32, pulse: u32) -> [bool; 2] {
        if self
            .decided
            .is_some_and(|then| now.wrapping_sub(then) >= pulse)
        {
            self.decided = None;
        }
        [self.touching != 0, self.decided.is_some()]
    }
}
