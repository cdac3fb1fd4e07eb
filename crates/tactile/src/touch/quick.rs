//! Curvature and surprise: the signs that begin a touch.

use super::level::{FRACTION, bounded};

/// Least thresholds at the start, codes.
const LEAST: u32 = 64;
/// The largest that it becomes.
const LEAST_MOST: u32 = 4095;
/// Bits of a least threshold below one code, and by 2^−n of itself it falls a block.
const LEAST_FRACTION: u32 = 20;
const FALL: u32 = 18;
/// How often what was lately a sign is that begins a touch, sixteenths.
const ABOVE_RECENT: u32 = 22;
/// What was lately falls by 2^−n of itself a block.
const RECENT: u32 = 3;

#[derive(Debug, Clone)]
pub(super) struct Quick {
    pub(super) level: u32,
    pub(super) least: u32,
    /// From where it begins a contact, codes.
    pub(super) threshold: u32,
    /// The largest of the block, of the last block, and, in 1/256, of what was before.
    pub(super) block: u32,
    pub(super) last: u32,
    pub(super) recent: u32,
    /// Of the touch: whether this began it, its threshold then, its peak.
    pub(super) began: bool,
    pub(super) at_onset: u32,
    pub(super) peak: u32,
}

impl Quick {
    pub(super) const fn new() -> Self {
        Self {
            level: 8 << FRACTION,
            least: LEAST << LEAST_FRACTION,
            threshold: LEAST,
            block: 0,
            last: 0,
            recent: 0,
            began: false,
            at_onset: 0,
            peak: 0,
        }
    }

    pub(super) const fn begins(&self, sign: u32) -> bool {
        sign > self.threshold && (sign << 12) > self.recent.wrapping_mul(ABOVE_RECENT)
    }

    /// A touch was missed.
    pub(super) const fn lower(&mut self) {
        self.least -= self.least / 4;
    }

    /// The touch was none.
    pub(super) fn raise(&mut self) {
        if self.began {
            let least = self.at_onset.saturating_add(self.at_onset / 4);
            let least = least.min(LEAST_MOST);
            self.least = least << LEAST_FRACTION;
            self.threshold = self.threshold.max(least);
        }
    }

    /// The end of a block; `factor`: how often its level begins a touch, sixteenths.
    pub(super) fn end_block(&mut self, factor: u32) {
        self.level = bounded(self.level);
        let fallen = self.recent - (self.recent >> RECENT);
        self.recent = fallen.max(self.last << 8);
        self.last = core::mem::take(&mut self.block);
        self.least -= self.least >> FALL;
        // A level has 30 bits, a factor 8.
        let of_level = ((self.level >> 8) * factor) >> 8;
        self.threshold = of_level.max(self.least >> LEAST_FRACTION);
    }
}
