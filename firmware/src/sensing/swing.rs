//! Whether a whisker feels that it is whisked: its inertia alone moves the reading.
//!
//! A sensor whose magnet is gone, and one on a stub of a whisker, answer with good frames in which
//! nothing moves; a magnet that has come off its place may read the end of the range for ever. What
//! such a sensor says is no touch, nor the air. A reading that whisking has never moved is not lost:
//! of a mock-up without a whisker nothing else is known.

use mlx90333::Word;
use serde::{Deserialize, Serialize};

use super::limits::SensorLimits;
use crate::faults::number;

/// What whisking must do to a reading.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct SwingLimits {
    /// Ticks of a look, some whisks.
    pub ticks: u16,
    /// Counts of the encoder between the ends of whisks from which a look tells anything.
    pub counts: u32,
    /// Steps of a word, of 65,536, that x must move by in them.
    pub least: u16,
}

/// One tick of so many is looked at: whisks last far longer, and a tick is dearer with a look.
const EVERY: u16 = 4;

/// Within this of either end of the range, of 65,536 steps, x says nothing.
const END: u16 = 16;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Lost {
    Still,
    /// It is at the end of its range, for a whole look.
    AtEnd,
}

impl Lost {
    pub(crate) const fn number(self) -> u8 {
        match self {
            Self::Still => number::UNFELT,
            Self::AtEnd => number::AT_END,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Swing {
    ticks: u16,
    x: [u16; 2],
    counts: [i32; 2],
    is_at_end: bool,
    /// Whether whisking has moved the reading since the start.
    was_felt: bool,
    is_lost: bool,
}

impl Swing {
    pub(crate) const fn new() -> Self {
        Self {
            ticks: 0,
            x: [u16::MAX, 0],
            counts: [i32::MAX, i32::MIN],
            is_at_end: true,
            was_felt: false,
            is_lost: false,
        }
    }

    /// Whether the last look has found that nothing is felt.
    #[inline]
    pub(crate) const fn is_lost(&self) -> bool {
        self.is_lost
    }

    /// The look begins again; what the last has found stays.
    const fn pause(&mut self) {
        let (was_felt, is_lost) = (self.was_felt, self.is_lost);
        *self = Self::new();
        (self.was_felt, self.is_lost) = (was_felt, is_lost);
    }

    /// `counts` are those of a motor that runs. Says what is lost where it was not lost before.
    #[inline]
    pub(crate) fn look(
        &mut self,
        limits: &SensorLimits,
        x: Word,
        counts: Option<i32>,
    ) -> Option<Lost> {
        self.ticks = self.ticks.saturating_add(1);
        if !self.ticks.is_multiple_of(EVERY) {
            return None;
        }
        self.look_now(limits, x, counts)
    }

    // Apart, so that the other ticks keep their registers.
    #[inline(never)]
    fn look_now(&mut self, limits: &SensorLimits, x: Word, counts: Option<i32>) -> Option<Lost> {
        let limits = limits.swing?;
        let Some(counts) = counts else {
            self.pause();
            return None;
        };
        let x = x.raw();
        let [low, high] = &mut self.x;
        (*low, *high) = ((*low).min(x), (*high).max(x));
        let [low, high] = &mut self.counts;
        (*low, *high) = ((*low).min(counts), (*high).max(counts));
        self.is_at_end &= !(END..=u16::MAX - END).contains(&x);
        if self.ticks < limits.ticks {
            return None;
        }
        self.judge(limits)
    }

    #[cold]
    fn judge(&mut self, limits: SwingLimits) -> Option<Lost> {
        let [low, high] = self.x;
        let [from, to] = self.counts;
        let tells = to.wrapping_sub(from).cast_unsigned() >= limits.counts;
        let is_still = high.saturating_sub(low) < limits.least;
        let found = if self.is_at_end {
            Some(Lost::AtEnd)
        } else if tells && is_still && self.was_felt {
            Some(Lost::Still)
        } else {
            None
        };
        self.was_felt |= tells && !is_still;
        let was_lost = self.is_lost;
        // What does not whisk tells nothing about a reading that did not move before.
        self.is_lost = found.is_some() || (was_lost && !tells);
        self.pause();
        found.filter(|_| !was_lost)
    }
}

#[cfg(test)]
mod tests {
    use super::{Lost, SensorLimits, Swing, SwingLimits};
    use mlx90333::Word;

    const LIMITS: SensorLimits = SensorLimits {
        swing: Some(SwingLimits {
            ticks: 100,
            counts: 500,
            least: 400,
        }),
        ..SensorLimits::ANY
    };

    /// What ten looks say of an x and an angle by tick, and whether nothing is felt in the end.
    fn looks(x: impl Fn(i32) -> u16, counts: impl Fn(i32) -> i32) -> (Vec<Lost>, bool) {
        let mut swing = Swing::new();
        let said = (0..1000)
            .filter_map(|tick| swing.look(&LIMITS, Word::new(x(tick)), Some(counts(tick))))
            .collect();
        (said, swing.is_lost())
    }

    fn whisks(tick: i32) -> i32 {
        10 * (tick % 60)
    }

    #[test]
    fn a_reading_that_does_not_move_with_the_whisker_is_said_once() {
        let noise = |tick: i32| 0x8000 + (tick % 7 * 57) as u16;
        let moves = |tick: i32| 0x8000 + (tick % 60 * 8) as u16;
        let gone = |tick: i32| if tick < 200 { moves(tick) } else { noise(tick) };
        assert_eq!(looks(gone, whisks), (vec![Lost::Still], true));
        assert_eq!(looks(noise, whisks), (vec![], false), "never felt");
        assert_eq!(looks(moves, whisks), (vec![], false));
        // A whisker that hardly whisks tells nothing.
        let hardly = |tick: i32| whisks(tick) / if tick < 200 { 1 } else { 2 };
        assert_eq!(looks(gone, hardly), (vec![], false));
    }

    #[test]
    fn a_reading_at_the_end_of_its_range_is_lost_and_one_that_touches_it_is_not() {
        for end in [0, 15, u16::MAX - 15, u16::MAX] {
            assert_eq!(looks(|_| end, |_| 0), (vec![Lost::AtEnd], true));
        }
        let touches = |tick: i32| if tick % 100 < 99 { u16::MAX } else { 0xF000 };
        assert_eq!(looks(touches, whisks), (vec![], false));
    }

    #[test]
    fn a_reading_that_moves_again_counts_again() {
        let moves = |tick: i32| (tick % 60 * 8) as u16;
        let is_gone = |tick: i32| (200..500).contains(&tick);
        let late = |tick: i32| 0x8000 + if is_gone(tick) { 0 } else { moves(tick) };
        assert_eq!(looks(late, whisks), (vec![Lost::Still], false));
    }
}
