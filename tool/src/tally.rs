//! Counting the records of each side, and those that are missing between two.

use wire::{Flags, TickRecord};

/// What stands before a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Before {
    /// The record of the tick before, or nothing at all.
    Nothing,
    Lost(u32),
    /// Ticks are counted from zero: the module has started again.
    Restart,
}

#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Tally {
    /// Of so many ticks there is one record; 0: of each.
    every: u32,
    last: [Option<u32>; 2],
    /// Whether the module has started again since.
    again: [bool; 2],
    pub(crate) records: u64,
    pub(crate) lost: u64,
    pub(crate) restarts: u64,
}

pub(crate) const SIDES: [&str; 2] = ["left", "right"];

/// 0 for a record of the left side, 1 for one of the right.
pub(crate) fn side(record: &TickRecord) -> usize {
    usize::from(record.flags.contains(Flags::RIGHT))
}

impl Tally {
    pub(crate) fn of_every(every: u32) -> Self {
        Self {
            every,
            ..Self::default()
        }
    }

    /// What comes next follows nothing: records between were not asked for.
    pub(crate) const fn skip(&mut self) {
        self.last = [None; 2];
    }

    /// The module has started again: what comes next follows nothing.
    pub(crate) const fn restart(&mut self) {
        self.restarts += 1;
        self.last = [None; 2];
        self.again = [true; 2];
    }

    /// Records are asked for up to this tick, which is none of them: those that have not come by now
    /// are lost.
    pub(crate) fn end(&mut self, sequence: u32) {
        for last in self.last.into_iter().flatten() {
            let left = sequence.wrapping_sub(last).wrapping_sub(1);
            if left < 0x8000_0000 {
                self.lost += u64::from(left / self.every.max(1));
            }
        }
    }

    pub(crate) fn take(&mut self, record: &TickRecord) -> Before {
        self.records += 1;
        let side = side(record);
        let last = self.last[side].replace(record.sequence);
        if std::mem::take(&mut self.again[side]) {
            return Before::Restart;
        }
        let Some(last) = last else {
            return Before::Nothing;
        };
        // Half of all numbers are ahead of one, and half behind it.
        let every = self.every.max(1);
        match record.sequence.wrapping_sub(last) {
            // A board that sends more than it was expected to has lost none.
            ahead if (1..=every).contains(&ahead) => Before::Nothing,
            ahead @ 1..0x8000_0000 => {
                let lost = ahead.div_ceil(every) - 1;
                self.lost += u64::from(lost);
                Before::Lost(lost)
            }
            _ => {
                self.restart();
                self.last[side] = Some(record.sequence);
                self.again[side] = false;
                Before::Restart
            }
        }
    }
}

/// Ticks since a module's last start, from numbers that wrap around. A few may come late, as a
/// side's after the other's.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct TickTime {
    wraps: u64,
    last: Option<u32>,
}

/// So many numbers back is late; farther back, the module has started again.
const LATE: u32 = 64;

impl TickTime {
    pub(crate) fn take(&mut self, sequence: u32) -> u64 {
        let last = self.last.unwrap_or(sequence);
        let back = last.wrapping_sub(sequence);
        let of_wraps = |wraps: u64| (wraps << 32) + u64::from(sequence);
        if (1..=LATE).contains(&back) {
            // Perhaps of before the wrap.
            return of_wraps(self.wraps.saturating_sub(u64::from(sequence > last)));
        }
        if back > 0 && back < 0x8000_0000 {
            self.wraps = 0;
        } else {
            self.wraps += u64::from(sequence < last);
        }
        self.last = Some(sequence);
        of_wraps(self.wraps)
    }
}

/// Ticks since a module's first start, from numbers that wrap around and restart.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct TickCount {
    ticks: u64,
    last: Option<u32>,
    has_restarted: bool,
}

impl TickCount {
    /// Goes on to the tick of this number; after another start it goes on by one.
    pub(crate) fn take(&mut self, sequence: u32) -> u64 {
        let last = self.last.replace(sequence);
        let ahead = sequence.wrapping_sub(last.unwrap_or(0));
        let has_restarted = std::mem::take(&mut self.has_restarted);
        self.ticks += match last {
            Some(_) if has_restarted || ahead >= 0x8000_0000 => 1,
            _ => u64::from(ahead),
        };
        self.ticks
    }

    /// The module has started again.
    pub(crate) const fn restart(&mut self) {
        self.has_restarted = true;
    }

    /// Goes on to a tick that is soon after the last; to any other it does not.
    pub(crate) fn reach(&mut self, sequence: u32) {
        let is_soon = |last| (1..=LATE).contains(&sequence.wrapping_sub(last));
        if self.last.is_some_and(is_soon) {
            self.take(sequence);
        }
    }

    pub(crate) const fn now(&self) -> u64 {
        self.ticks
    }
}

#[cfg(test)]
mod tests {
    use wire::Flags;

    use super::{Before, Tally, TickCount, TickTime};
    use crate::source::record;

    #[test]
    fn sides_are_counted_apart_and_numbers_wrap() {
        let mut tally = Tally::default();
        let (left, right) = (Flags::default(), Flags::RIGHT);
        for (sequence, flags, before) in [
            (u32::MAX, left, Before::Nothing),
            (u32::MAX, right, Before::Nothing),
            (0, left, Before::Nothing),
            (2, right, Before::Lost(2)),
            (1, left, Before::Nothing),
            (1, left, Before::Restart),
            // The same start.
            (1, right, Before::Restart),
            (2, right, Before::Nothing),
        ] {
            assert_eq!(tally.take(&record(sequence, flags)), before);
        }
        assert_eq!((tally.records, tally.lost, tally.restarts), (8, 2, 1));
        // Of the left side 2 to 4, of the right 3 and 4.
        tally.end(5);
        assert_eq!(tally.lost, 7);
        tally.restart();
        assert_eq!(tally.take(&record(900, Flags::default())), Before::Restart);
    }

    #[test]
    fn one_of_several_ticks_is_none_lost() {
        let mut tally = Tally::of_every(20);
        let mut take = |sequence| tally.take(&record(sequence, Flags::default()));
        assert_eq!([20, 40, 100].map(&mut take)[2], Before::Lost(2));
        assert_eq!((tally.records, tally.lost), (3, 2));
    }

    #[test]
    fn time_goes_on_where_numbers_wrap_and_begins_again_with_the_module() {
        let mut time = TickTime::default();
        let wrap = 1_u64 << 32;
        for (number, expected) in [
            (u32::MAX - 1, wrap - 2),
            (u32::MAX, wrap - 1),
            (1, wrap + 1),
            // Late.
            (u32::MAX, wrap - 1),
            (0, wrap),
            (0x7000_0000, wrap + 0x7000_0000),
            // Started again.
            (3, 3),
            (4, 4),
        ] {
            assert_eq!(time.take(number), expected, "{number}");
        }
    }

    #[test]
    fn ticks_go_on_where_numbers_wrap_and_restart() {
        let mut ticks = TickCount::default();
        let numbers = [u32::MAX - 1, u32::MAX - 1, 1, 0x7000_0000, 1, 2];
        let first = u64::from(u32::MAX - 1);
        let later = first + 0x7000_0002;
        let expected = [first, first, first + 3, later, later + 1, later + 2];
        assert_eq!(numbers.map(|number| ticks.take(number)), expected);
    }
}
