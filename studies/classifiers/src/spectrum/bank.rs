//! A resonator a bin, stepped with every sample: the Goertzel algorithm in the
//! form of Reinsch, which keeps its precision at low frequencies.
//!
//! With θ = 2πk/N, s(n) = x(n) + 2 cos θ s(n − 1) − s(n − 2), and after the block
//! |X|² = s² + s'² − 2 cos θ s s', s' being the state before the last. Stepping
//! differences instead, d = s − s', the factor near two becomes a small one,
//! a = 2 cos θ − 2 = −4 sin²(θ/2), exact to the last digit of single precision:
//!
//! d ← d + a s + x, s ← s + d, |X|² = d² − a s (s − d).
//!
//! Above a quarter of the rate the sums d = s + s' play that role, with
//! a = 2 cos θ + 2 = 4 cos²(θ/2): d ← −d + a s + x, s ← −s + d,
//! |X|² = d² + a s (s − d).

use super::{Bins, Measure};
use crate::error::Error;

/// B bins of a block: immutable, can be a constant in flash (`4 B + 8` bytes).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bank<const B: usize> {
    /// Factor a of each bin.
    factors: [f32; B],
    /// Bins up to a quarter of the rate; they come first.
    low: usize,
    /// Samples in a block, not zero.
    block: u32,
}

/// What changes from sample to sample: `8 B + 4` bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BankState<const B: usize> {
    /// s and d of each bin.
    resonators: [[f32; 2]; B],
    /// Samples to the end of the block.
    left: u32,
}

impl<const B: usize> Bank<B> {
    /// The resonators of some bins, for blocks of so many samples.
    ///
    /// # Errors
    ///
    /// Bins or block are out of range, or the bins are not B.
    pub fn new(bins: &Bins, block: u32) -> Result<Self, Error> {
        bins.check_block(block as usize)?;
        if bins.count != B {
            return Err(Error::Length {
                expected: B,
                found: bins.count,
            });
        }
        let points = f64::from(bins.points);
        let low = bins.indices().filter(|&k| 4 * k <= bins.points).count();
        let mut factors = [0.0; B];
        for (bin, (factor, k)) in factors.iter_mut().zip(bins.indices()).enumerate() {
            let half = core::f64::consts::PI * f64::from(k) / points;
            let exact = if bin < low {
                -4.0 * libm::sin(half) * libm::sin(half)
            } else {
                4.0 * libm::cos(half) * libm::cos(half)
            };
            *factor = exact as f32;
        }
        Ok(Self {
            factors,
            low,
            block,
        })
    }

    /// A bank from its parts, for constants: as [`Self::parts`] gave them.
    /// Out of range they give a wrong spectrum, and nothing worse.
    pub const fn from_parts(factors: [f32; B], low: usize, block: u32) -> Self {
        Self {
            factors,
            low: if low < B { low } else { B },
            block: if block == 0 { 1 } else { block },
        }
    }

    /// Factors, how many of them are of the first form, samples in a block.
    pub const fn parts(&self) -> (&[f32; B], usize, u32) {
        (&self.factors, self.low, self.block)
    }

    /// Samples in a block.
    pub const fn block(&self) -> u32 {
        self.block
    }

    /// The state before the first sample.
    pub const fn state(&self) -> BankState<B> {
        BankState {
            resonators: [[0.0; 2]; B],
            left: self.block,
        }
    }

    /// Takes a sample. True: the block is complete; [`Self::read`] it before
    /// the next sample, which begins another.
    #[inline]
    pub fn push(&self, state: &mut BankState<B>, x: f32) -> bool {
        if state.left == 0 {
            *state = self.state();
        }
        let (low, high) = self.factors.split_at(self.low);
        let (below, above) = state.resonators.split_at_mut(self.low);
        for ([s, d], a) in below.iter_mut().zip(low) {
            *d += a * *s + x;
            *s += *d;
        }
        for ([s, d], a) in above.iter_mut().zip(high) {
            *d = a * *s + x - *d;
            *s = *d - *s;
        }
        state.left -= 1;
        state.left == 0
    }

    /// The spectrum of the samples so far, which is that of a block once
    /// [`Self::push`] has said so (before: as if zeros followed).
    pub fn read(&self, state: &BankState<B>, measure: Measure) -> [f32; B] {
        let mut bins = [0.0; B];
        let resonators = state.resonators.iter().zip(&self.factors);
        let (low, high) = bins.split_at_mut(self.low);
        for (bin, ([s, d], a)) in low.iter_mut().zip(resonators.clone()) {
            *bin = positive(d * d - a * s * (s - d));
        }
        for (bin, ([s, d], a)) in high.iter_mut().zip(resonators.skip(self.low)) {
            *bin = positive(d * d + a * s * (s - d));
        }
        if measure == Measure::Magnitude {
            for bin in &mut bins {
                *bin = root(*bin);
            }
        }
        bins
    }
}

/// Zero for what rounding took below it, and for what is no number. By hand, as
/// `max` is a call where the unit has no instruction for it.
#[inline]
fn positive(power: f32) -> f32 {
    if power > 0.0 { power } else { 0.0 }
}

/// √x for x ≥ 0, within 3e-7 of itself; zero below 1.2e-38. A first guess of
/// 1/√x from the exponent (within 3.5 %), one step of third order (within
/// 4e-5), one of second order: a quarter of what a correctly rounded root costs
/// without the processor's own, which the core library does not offer.
#[inline]
fn root(x: f32) -> f32 {
    if x < f32::MIN_POSITIVE {
        return 0.0;
    }
    let guess = f32::from_bits(0x5F37_5A86_u32.wrapping_sub(x.to_bits() >> 1));
    let w = x * guess * guess;
    let y = guess * (1.875 - w * (1.25 - 0.375 * w));
    let near = x * y;
    near + near * (0.5 - 0.5 * near * y)
}

#[cfg(test)]
mod tests {
    use super::root;

    #[test]
    fn roots_are_within_their_bound() {
        let mut worst = 0.0_f64;
        // Every exponent but the last, and a mantissa that moves.
        for bits in (f32::MIN_POSITIVE.to_bits()..f32::MAX.to_bits()).step_by(99_991) {
            let x = f32::from_bits(bits);
            let exact = f64::from(x).sqrt();
            worst = worst.max((f64::from(root(x)) / exact - 1.0).abs());
        }
        assert!(worst < 3e-7, "{worst:e}");
        assert_eq!(root(0.0), 0.0);
        assert_eq!(root(1e-40), 0.0);
    }
}
