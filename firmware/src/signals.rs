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

#[cfg(test)]
mod tests {
    use super::Signals;
    use crate::{Event, Place};
    use tactile::Decision;

    #[test]
    fn contact_is_of_any_whisker_and_decisions_are_pulses() {
        let mut signals = Signals::new();
        let [left, right] = [0, 1].map(|side| Place::new(side, 0));
        let touch = |place| Event::Touch { place, number: 1 };
        let end = |place| Event::TouchEnd { place, number: 1 };
        assert_eq!(signals.levels(0, 20), [false, false]);
        signals.note(&touch(left), 1);
        signals.note(&touch(right), 1);
        signals.note(&end(left), 2);
        assert_eq!(signals.levels(2, 20), [true, false]);
        signals.note(&end(right), 3);
        assert_eq!(signals.levels(3, 20), [false, false]);
        // Across the wrap of the count.
        let now = u32::MAX - 5;
        let decision = Decision::from_memory(1, 0, 0).unwrap();
        signals.note(&Event::Decision(left, decision), now);
        assert_eq!(signals.levels(now, 20), [false, true]);
        assert_eq!(signals.levels(now.wrapping_add(10), 20), [false, true]);
        // Another one makes it longer.
        signals.note(&Event::Decision(left, decision), now.wrapping_add(10));
        assert_eq!(signals.levels(now.wrapping_add(29), 20), [false, true]);
        assert_eq!(signals.levels(now.wrapping_add(30), 20), [false, false]);
        assert_eq!(signals.levels(now.wrapping_add(31), 20), [false, false]);
    }
}
