//! How rough a surface feels: the second difference of a channel over some
//! milliseconds, summed over a block.
//!
//! S = Σ |v\[n\] − 2 v\[n − 4\] + v\[n − 8\]| over the samples of the block that count;
//! the code that a table is looked up by is 64 log₂(1 + S). At 2 kHz the difference
//! is largest at 250 Hz and takes the whisk itself out.

use crate::format::ROUGH_CHANNELS;

/// Samples between the terms of the difference.
const DELAY: usize = 4;
pub(crate) const KEPT: usize = 2 * DELAY;
/// Bits of a code's fraction: 1/64 octave.
const FRACTION_BITS: u32 = 6;

/// The delay lines of the first two channels, and their sums over the open block.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Roughness {
    line: [[i32; ROUGH_CHANNELS]; KEPT],
    sums: [u32; ROUGH_CHANNELS],
    /// The place of the oldest sample, by its lower bits; at least [`KEPT`] once the
    /// line is full.
    oldest: usize,
}

impl Roughness {
    pub(crate) const fn new() -> Self {
        Self {
            line: [[0; ROUGH_CHANNELS]; KEPT],
            sums: [0; ROUGH_CHANNELS],
            oldest: 0,
        }
    }

    /// Takes a sample, of all channels of the model. The delay line runs on with those
    /// that do not count; until it is full there is no difference. That of codes beyond
    /// ±2²⁹ wraps around.
    #[inline(never)]
    pub(crate) fn push(&mut self, codes: &[i32], counts: bool) {
        let new = match *codes {
            [x, y, ..] => [x, y],
            [x] => [x, 0],
            [] => return,
        };
        let middle = self.line[self.oldest.wrapping_add(DELAY) % KEPT];
        let oldest = core::mem::replace(&mut self.line[self.oldest % KEPT], new);
        if counts && self.is_full() {
            for channel in 0..ROUGH_CHANNELS {
                let ends = new[channel].wrapping_add(oldest[channel]);
                let difference = ends.wrapping_sub(middle[channel].wrapping_mul(2));
                let sum = &mut self.sums[channel];
                *sum = sum.saturating_add(difference.unsigned_abs());
            }
        }
        // Beyond that only with flipped bits.
        self.oldest = if self.oldest < 2 * KEPT - 1 {
            self.oldest + 1
        } else {
            KEPT
        };
    }

    /// Whether the next sample has a difference.
    #[inline]
    pub(crate) const fn is_full(&self) -> bool {
        self.oldest >= KEPT
    }

    /// The code of a channel over the open block; 0 to 2047.
    #[inline]
    pub(crate) fn code(&self, channel: usize) -> i32 {
        let sum = self.sums.get(channel).copied().unwrap_or(0);
        octaves(sum.saturating_add(1))
    }

    /// Samples are missing: there is no difference again until the delay line is full.
    #[inline]
    pub(crate) const fn interrupt(&mut self) {
        self.oldest = 0;
    }

    #[inline]
    pub(crate) fn clear(&mut self) {
        self.sums = [0; ROUGH_CHANNELS];
    }
}

/// 64 log₂ x for x ≥ 1, with the fraction of x's leading bit taken as its logarithm:
/// at most 6.6 too low.
#[inline]
fn octaves(x: u32) -> i32 {
    let whole = u32::BITS - 1 - x.leading_zeros().min(u32::BITS - 1);
    // The leading one goes, then the bits below it stand at the top.
    let below = (x << (u32::BITS - 1 - whole)) << 1;
    ((whole << FRACTION_BITS) | (below >> (u32::BITS - FRACTION_BITS))) as i32
}

#[cfg(test)]
mod tests {
    use super::{KEPT, Roughness, octaves};

    fn code(samples: &[i32]) -> i32 {
        let mut roughness = Roughness::new();
        for &x in samples {
            roughness.push(&[x], true);
        }
        roughness.code(0)
    }

    #[test]
    fn octaves_follow_the_logarithm() {
        let mut worst = 0.0_f64;
        for x in (1..1 << 16).chain([u32::MAX - 1, u32::MAX]) {
            let exact = 64.0 * f64::from(x).log2();
            let error = exact - f64::from(octaves(x));
            assert!((0.0..=6.6).contains(&error), "{x}: {error}");
            worst = worst.max(error);
        }
        assert!(worst > 6.4, "{worst}");
        assert_eq!(octaves(u32::MAX), 2047);
        assert_eq!([1, 2, 3, 4, 1 << 20].map(octaves), [0, 64, 96, 128, 1280]);
    }

    #[test]
    fn a_rest_and_a_ramp_are_smooth_and_a_step_is_not() {
        assert_eq!(code(&[5_000; 20]), 0);
        let ramp: Vec<i32> = (0..100).map(|n| 7 * n).collect();
        let mut roughness = Roughness::new();
        for (n, &x) in ramp.iter().enumerate() {
            roughness.push(&[x], n >= KEPT);
        }
        assert_eq!(roughness.code(0), 0);
        // A step of 10: four differences of 10, then four of −10.
        let step: Vec<i32> = (0..30).map(|n| 10 * i32::from(n >= 10)).collect();
        assert_eq!(code(&step), octaves(81));
    }

    #[test]
    fn samples_in_the_air_keep_the_line_but_do_not_count() {
        let mut roughness = Roughness::new();
        for n in 0..8 {
            roughness.push(&[100 * (n % 2)], false);
        }
        assert_eq!(roughness.code(0), 0);
        // v[n - 8] = v[n - 4] = 0.
        roughness.push(&[50], true);
        assert_eq!(roughness.code(0), octaves(51));
        roughness.clear();
        assert_eq!(roughness.code(0), 0);
    }

    #[test]
    fn across_a_gap_there_is_no_difference() {
        let mut roughness = Roughness::new();
        for n in 0..30 {
            if n == 20 {
                roughness.interrupt();
            }
            roughness.push(&[if n < 20 { 0 } else { 1000 }], true);
        }
        assert_eq!(roughness.code(0), 0);
        roughness.push(&[1050], true);
        assert_eq!(roughness.code(0), octaves(51), "the line is full again");
    }

    #[test]
    fn a_spoilt_place_is_forgotten_with_the_line() {
        for bit in 0..usize::BITS {
            let mut roughness = Roughness::new();
            for n in 0..40 {
                if n == 19 {
                    roughness.oldest ^= 1 << bit;
                }
                if n == 19 + 2 * KEPT as i32 {
                    roughness.clear();
                }
                roughness.push(&[7 * n], true);
            }
            assert_eq!(roughness.code(0), 0, "{bit}: a ramp is smooth");
            assert!((KEPT..2 * KEPT).contains(&roughness.oldest));
        }
    }

    #[test]
    fn extremes_do_not_overflow() {
        let step = (1 << 29) - 1;
        let wild: Vec<i32> = (0..4_000)
            .map(|n| if n % 8 < 4 { -step } else { step })
            .collect();
        assert_eq!(code(&wild), 2047);
        for x in [i32::MIN, i32::MAX] {
            assert_eq!(code(&[x; 20]), 0);
            code(&[x, 0, -1, 1, x, x, 0, x, x, 0, 0, 0, x]);
        }
    }
}
