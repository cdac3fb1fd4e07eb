//! How rough a surface feels: the second difference of a channel over some
//! milliseconds, summed over a block.
//!
//! S = Σ |v\[n\] − 2 v\[n − 4\] + v\[n − 8\]| over the samples of the block that count;
//! the code that a table is looked up by is 64 log₂(1 + S). At 2 kHz the difference
//! is largest at 250 Hz and takes the whisk itself out.

use crate::format::MAX_ROUGH_AXES;

/// Samples between the terms of the difference.
const DELAY: usize = 4;
/// Samples that are kept.
const KEPT: usize = 2 * DELAY;
/// Bits of a code's fraction: 1/64 octave.
const FRACTION_BITS: u32 = 6;

/// The delay line of [`MAX_ROUGH_AXES`] channels, and their sums over the open block.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Roughness {
    channels: [u8; MAX_ROUGH_AXES],
    line: [[i32; MAX_ROUGH_AXES]; KEPT],
    sums: [u32; MAX_ROUGH_AXES],
    /// The oldest sample of the line.
    oldest: usize,
    /// Samples until the line is full.
    missing: usize,
}

impl Roughness {
    /// Of these channels; those beyond [`MAX_ROUGH_AXES`] are left out, and what
    /// remains is channel 0 again.
    pub fn of(channels: impl Iterator<Item = u8>) -> Self {
        let mut kept = [0; MAX_ROUGH_AXES];
        for (place, channel) in kept.iter_mut().zip(channels) {
            *place = channel;
        }
        Self {
            channels: kept,
            line: [[0; MAX_ROUGH_AXES]; KEPT],
            sums: [0; MAX_ROUGH_AXES],
            oldest: 0,
            missing: KEPT,
        }
    }

    /// Takes a sample, of all channels of the model. The delay line runs on with those
    /// that do not count; until it is full there is no difference. That of codes beyond
    /// ±2²⁹ wraps around.
    #[inline]
    pub fn push(&mut self, codes: &[i32], counts: bool) {
        let code = |channel: u8| codes.get(usize::from(channel)).copied().unwrap_or(0);
        let new = self.channels.map(code);
        let middle = self.line[(self.oldest + DELAY) % KEPT];
        let oldest = core::mem::replace(&mut self.line[self.oldest % KEPT], new);
        self.oldest = (self.oldest + 1) % KEPT;
        if self.missing > 0 {
            self.missing -= 1;
        } else if counts {
            let differences = new.iter().zip(middle).zip(oldest);
            for (sum, ((new, middle), oldest)) in self.sums.iter_mut().zip(differences) {
                let difference = new
                    .wrapping_add(oldest)
                    .wrapping_sub(middle.wrapping_mul(2));
                *sum = sum.saturating_add(difference.unsigned_abs());
            }
        }
    }

    /// The code of a channel over the open block, by its place; 0 to 2047.
    #[inline]
    pub fn code(&self, place: usize) -> i32 {
        let sum = self.sums.get(place).copied().unwrap_or(0);
        octaves(sum.saturating_add(1))
    }

    /// Begins another block.
    #[inline]
    pub fn clear(&mut self) {
        self.sums = [0; MAX_ROUGH_AXES];
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
        let mut roughness = Roughness::of([0].into_iter());
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
        let mut roughness = Roughness::of([0].into_iter());
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
        let mut roughness = Roughness::of([0].into_iter());
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
