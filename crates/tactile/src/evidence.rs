//! From sums of log-likelihoods to posteriors.
//!
//! All evidence is held in table units (1/1024 bit) times the block, exact
//! integers; dividing by the block waits until the exponent of the posterior,
//! where the whole scale is one multiplication. With deficits d_j of the
//! classes behind the leader, its posterior is
//! p = 1 / Σ_j 2^(−d_j / (1024 · block)).

use crate::exp2::{INDEX_BITS, ONE, TERM_BITS, exp2_neg};
use crate::format::ENTRIES_PER_BIT;

/// Largest deficit that is distinguished: 2²⁹ − 1 units, 52 bit of evidence in
/// blocks of 10000 samples and 26214 bit in blocks of 20. Classes further
/// behind are held there. It keeps the evidence of a stream that never
/// decides in a word: 2²⁹ + 65535 · 20480 < 2³¹.
pub(crate) const MAX_DEFICIT: u32 = (1 << 29) - 1;

/// More than any odds against the leader of 32 classes, Q26.
pub(crate) const MAX_ODDS: u32 = 32 * ONE;

/// 2³⁹ / 1024: turns deficits into units of 2⁻³⁹ bit.
const RATE_OF_ONE: u32 = 1 << (32 + INDEX_BITS - ENTRIES_PER_BIT.ilog2());

/// The number of samples whose mean is one step of evidence, as a multiplier.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EvidenceScale {
    /// 2³⁹ / (1024 · samples), rounded: within samples / 2³⁰ relative.
    rate: u32,
}

impl EvidenceScale {
    /// For the mean over this many samples (at least one; zero counts as one).
    pub const fn per_samples(samples: u32) -> Self {
        let samples = if samples == 0 { 1 } else { samples };
        Self {
            rate: (RATE_OF_ONE + samples / 2) / samples,
        }
    }

    /// 2^(gain − d) for a deficit of at most [`MAX_DEFICIT`], Q26; see [`exp2_neg`].
    #[inline]
    pub(crate) fn term(self, deficit: u32, gain: i32) -> u32 {
        exp2_neg(u64::from(deficit) * u64::from(self.rate), gain)
    }

    /// The least deficit whose [`Self::term`] is below `bound`, which is at
    /// most 2²⁵ where `gain` > 0; [`MAX_DEFICIT`] + 1 where none is.
    pub(crate) fn first_below(self, gain: u8, bound: u32) -> u32 {
        let gain = i32::from(gain);
        if self.term(0, gain) < bound {
            return 0;
        }
        // Terms never rise with the deficit but where the gain lifts them
        // above one, and there all are above the bound: so the last that is
        // not below it is found bit by bit.
        let mut last = 0;
        for bit in (0..MAX_DEFICIT.count_ones()).rev() {
            let further = last | (1 << bit);
            if self.term(further, gain) >= bound {
                last = further;
            }
        }
        last + 1
    }

    /// Odds against the leader, Σ over the others of 2^−d, times 2^gain, Q26:
    /// but None where they reach `bound`, which is at most 2³¹.
    pub(crate) fn odds_below(self, deficits: &[u32], gain: u8, bound: u32) -> Option<u32> {
        let gain = i32::from(gain);
        // The leader's own term is exactly one, and in the sum: at most
        // 32 · 2²⁶ = 2³¹.
        let sum = deficits
            .iter()
            .fold(0_u32, |sum, &d| sum.wrapping_add(self.term(d, gain)));
        let odds = sum.wrapping_sub(ONE);
        (odds < bound).then_some(odds)
    }

    /// Turns deficits into posteriors, in units of 2⁻³², at most 2³² − 1. For
    /// display: one 64-bit division.
    pub fn posteriors(self, deficits: &mut [u32]) {
        let mut sum = 0;
        for value in deficits.iter_mut() {
            *value = self.term(*value, 0);
            sum += u64::from(*value);
        }
        // The sum is at least one: a deficit is always zero somewhere.
        let inverse = (1_u64 << (32 + TERM_BITS)).checked_div(sum).unwrap_or(0);
        for value in deficits {
            let posterior = (u64::from(*value) * inverse) >> TERM_BITS;
            *value = u32::try_from(posterior).unwrap_or(u32::MAX);
        }
    }
}

/// Index of the first class without a deficit: the leader, and on a perfect
/// tie the one that comes first in the training file.
pub(crate) fn leader(deficits: &[u32]) -> usize {
    deficits.iter().position(|&d| d == 0).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn posteriors_match_closed_form() {
        // Deficits of 0, 1 and 3 bit in blocks of 20.
        let unit = 20 * ENTRIES_PER_BIT;
        let scale = EvidenceScale::per_samples(20);
        let deficits = [unit, 0, 3 * unit];
        let mut found = deficits;
        scale.posteriors(&mut found);
        for (found, share) in found.into_iter().zip([0.5, 1.0, 0.125]) {
            assert!((f64::from(found) / 2.0_f64.powi(32) - share / 1.625).abs() < 1e-7);
        }
        let odds = f64::from(scale.odds_below(&deficits, 0, MAX_ODDS).unwrap()) / f64::from(ONE);
        assert!((odds - 0.625).abs() < 1e-7);
    }

    #[test]
    fn all_of_thirty_two_tied() {
        let scale = EvidenceScale::per_samples(1);
        assert_eq!(scale.odds_below(&[0; 32], 0, MAX_ODDS), Some(31 * ONE));
        assert_eq!(scale.odds_below(&[0; 32], 0, 31 * ONE), None);
        let mut posteriors = [0; 32];
        scale.posteriors(&mut posteriors);
        assert_eq!(posteriors, [1 << 27; 32]);
        assert_eq!(leader(&[0; 32]), 0);
    }

    #[test]
    fn a_near_rival_alone_reaches_the_bound_and_a_far_one_does_not() {
        for (block, gain, bound) in [
            (1, 0, ONE),
            (1, 0, ONE / 4 + 1),
            (20, 6, (1 << 25) - 1_234_567),
            (20, 40, 1 << 25),
            (10_000, 7, (1 << 24) + 1),
        ] {
            let scale = EvidenceScale::per_samples(block);
            let far = scale.first_below(gain, bound);
            assert!(far > 0);
            assert_eq!(scale.odds_below(&[far - 1, 0], gain, bound), None);
            assert!(scale.odds_below(&[far, 0], gain, bound).is_some());
            for near in (0..far).step_by(997) {
                assert_eq!(scale.odds_below(&[0, near], gain, bound), None);
            }
            // 2^(gain − far / (1024 · block)) is the bound.
            let units = f64::from(far) / f64::from(ENTRIES_PER_BIT * block);
            let exact = f64::from(gain) - (f64::from(bound) / f64::from(ONE)).log2();
            let is_near = (units / exact - 1.0).abs() < 2e-5 || (units - exact).abs() < 2e-3;
            assert!(is_near, "{units} {exact}");
        }
        let scale = EvidenceScale::per_samples(20);
        assert_eq!(scale.first_below(0, MAX_ODDS), 0, "even a tie decides");
        let scale = EvidenceScale::per_samples(10_000);
        assert_eq!(scale.first_below(60, 1 << 25), MAX_DEFICIT + 1);
    }

    #[test]
    fn scale_is_within_its_bound() {
        for block in 1..=10_000_u32 {
            let exact = 2.0_f64.powi(29) / f64::from(block);
            let error = f64::from(EvidenceScale::per_samples(block).rate) / exact - 1.0;
            assert!(error.abs() <= f64::from(block) / 2.0_f64.powi(30));
        }
    }
}
