//! Whether the tick keeps its time.

/// Longest tick and missed deadlines, in counts of the [`Clock`](crate::Clock).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Timing {
    /// Longest tick since the last [`Timing::take_worst`].
    worst: u32,
    /// Ticks that did not start in their period, since the beginning.
    missed: u32,
    begun: u32,
    has_begun: bool,
}

impl Timing {
    /// A tick begins at `now`; one is due every `period` counts (0: not known).
    #[inline]
    pub fn begin(&mut self, now: u32, period: u32) {
        if self.has_begun {
            // Up to a third more than a period, no tick can be lost.
            let elapsed = now.wrapping_sub(self.begun);
            if elapsed - elapsed / 4 > period {
                self.miss(elapsed, period);
            }
        }
        self.begun = now;
        self.has_begun = true;
    }

    /// Half a period of jitter is none; more means that whole ticks are lost.
    #[cold]
    fn miss(&mut self, elapsed: u32, period: u32) {
        let rounded = elapsed.saturating_add(period / 2);
        let periods = rounded.checked_div(period).unwrap_or(0);
        self.missed = self.missed.saturating_add(periods.saturating_sub(1));
    }

    /// The tick that began last ends at `now`; one has begun.
    #[inline]
    pub fn end(&mut self, now: u32) {
        self.worst = self.worst.max(now.wrapping_sub(self.begun));
    }

    /// Ticks lost since the beginning.
    pub const fn missed(&self) -> u32 {
        self.missed
    }

    /// Longest tick since the last call, counts.
    pub fn take_worst(&mut self) -> u32 {
        core::mem::take(&mut self.worst)
    }
}

#[cfg(test)]
mod tests {
    use super::Timing;

    #[test]
    fn lost_ticks_are_counted_and_jitter_is_not() {
        let mut timing = Timing::default();
        let start = u32::MAX - 150;
        for now in [0, 100, 240, 300, 400, 700, 800] {
            timing.begin(start.wrapping_add(now), 100);
            timing.end(start.wrapping_add(now + now / 10));
        }
        assert_eq!(timing.missed(), 2, "500 and 600 did not happen");
        assert_eq!(timing.take_worst(), 80);
        assert_eq!(timing.take_worst(), 0);
    }
}
