//! Whether the words of frames that are good in themselves can be a whisker's.

use mlx90333::Word;

use super::limits::SensorLimits;
use crate::SensorFault;

#[derive(Debug, Clone, Copy)]
pub(super) struct Course {
    /// Those that were believed last.
    pub(super) words: [Word; 2],
    /// Frames in succession that have repeated them.
    pub(super) repeats: u16,
    /// Ticks since them without a frame that could be believed.
    missed: u16,
}

impl Course {
    /// Nothing is known: any words may follow, and none repeat these, which no good frame has.
    pub(super) const UNKNOWN: Self = Self {
        words: [Word::new(0); 2],
        repeats: 0,
        missed: u16::MAX,
    };

    /// [`SensorFault::Jump`] if they are too far from the last: then those stay.
    /// [`SensorFault::Frozen`] if they have been the same for too long.
    #[inline]
    pub(super) fn follow(
        &mut self,
        words: [Word; 2],
        limits: &SensorLimits,
    ) -> Result<(), SensorFault> {
        let ([x, y], [last_x, last_y]) = (words, self.words);
        let dx = x.raw().abs_diff(last_x.raw());
        let dy = y.raw().abs_diff(last_y.raw());
        let jump = dx.max(dy);
        let most = || limits.jump.saturating_mul(self.missed.saturating_add(1));
        // Nearly always less than is tolerated in a tick.
        if jump > limits.jump && jump > most() {
            return Err(SensorFault::Jump);
        }
        self.repeats = if dx | dy == 0 {
            self.repeats.saturating_add(1)
        } else {
            0
        };
        self.words = words;
        self.missed = 0;
        // At the limit of its type it does not count on.
        if self.repeats > limits.frozen {
            return Err(SensorFault::Frozen);
        }
        Ok(())
    }

    pub(super) const fn miss(&mut self) {
        self.missed = self.missed.saturating_add(1);
    }
}
