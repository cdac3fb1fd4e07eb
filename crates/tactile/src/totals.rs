//! Evidence of rules that decide by the largest sum over many blocks.

use crate::class_setting::ClassSettings;
use crate::decision::{Decision, Posterior};
use crate::evidence::{EvidenceScale, MAX_DEFICIT, MAX_ODDS, leader};
use crate::format::MAX_CLASSES;
use crate::words::PRIORS;

/// Sums over many blocks, exact: u64 a class. Never wraps, and saturates only
/// after 2⁶⁴ / (20480 · C) samples, about a million years at 2 kHz.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Totals {
    sums: [u64; MAX_CLASSES],
    /// Saturated.
    samples: u32,
}

impl Totals {
    pub const fn new() -> Self {
        Self {
            sums: [0; MAX_CLASSES],
            samples: 0,
        }
    }

    /// Of no block, where classes have these priors, in blocks of so many samples.
    pub(crate) fn of_priors(classes: &ClassSettings, block: u32) -> Self {
        let mut totals = Self::new();
        if PRIORS {
            let most = u32::from(u16::MAX) * block;
            for (class, sum) in totals.sums.iter_mut().enumerate() {
                *sum = u64::from(most - classes.behind(class, block));
            }
        }
        totals
    }

    /// Adds the sums of each class over so many samples.
    pub fn add(&mut self, sums: &[u32], samples: u32) {
        for (total, &sum) in self.sums.iter_mut().zip(sums) {
            *total = total.saturating_add(u64::from(sum));
        }
        self.samples = self.samples.saturating_add(samples);
    }

    /// Samples in them, at most 2³² − 1.
    pub const fn samples(&self) -> u32 {
        self.samples
    }

    /// By how much each class lies behind the leader.
    // There once, and as small as this crate is built.
    #[inline(never)]
    pub fn deficits(&self, deficits: &mut [u32]) {
        // Sums beyond the classes are zero.
        let sums = self.sums.get(..deficits.len()).unwrap_or_default();
        let most = sums.iter().copied().max().unwrap_or(0);
        for (deficit, sum) in deficits.iter_mut().zip(self.sums) {
            *deficit = u32::try_from(most - sum).map_or(MAX_DEFICIT, |d| d.min(MAX_DEFICIT));
        }
    }

    /// The leader of so many classes, by all samples.
    pub fn decide(&self, classes: usize, scale: EvidenceScale) -> Decision {
        let mut deficits = [0; MAX_CLASSES];
        let deficits = deficits.get_mut(..classes).unwrap_or_default();
        self.deficits(deficits);
        // 32 classes cannot reach the bound.
        let against = scale.odds_below(deficits, 0, MAX_ODDS).unwrap_or(MAX_ODDS);
        let posterior = Posterior::from_odds_against(against, 0);
        Decision::new(leader(deficits), self.samples, posterior)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn totals_neither_wrap_nor_lose_the_leader() {
        let mut totals = Totals {
            samples: u32::MAX,
            ..Totals::new()
        };
        totals.sums[..2].copy_from_slice(&[u64::MAX - 5, u64::MAX - 1_u64.rotate_right(20)]);
        totals.add(&[10, 10], 10);
        assert_eq!(totals.samples, u32::MAX);
        let mut deficits = [7; 2];
        totals.deficits(&mut deficits);
        assert_eq!(deficits, [0, MAX_DEFICIT]);
        let decision = totals.decide(2, EvidenceScale::per_samples(1));
        assert_eq!(decision.class(), Some(0));
        assert_eq!(decision.posterior().q32(), u32::MAX);
    }
}
