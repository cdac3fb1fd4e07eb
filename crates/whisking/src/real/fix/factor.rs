//! The format of fixed point, and constants of the tick in it.

use crate::math::product::{by_constant, by_half, high};

/// Bits behind the point.
pub(super) const FRACTION: u32 = 28;
/// Where products and readings saturate: 4.
pub(super) const SATURATED: i32 = 4 << FRACTION;

/// A constant with a scale of its own: `mantissa` · 2^-(16 + `shift`), within
/// 3.1e-5 of its value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "bake", derive(databake::Bake), databake(path = whisking))]
pub struct Factor {
    /// Magnitude 2^14 to 2^15 − 1, or zero.
    pub mantissa: i16,
    /// −30 to 46.
    pub shift: i32,
}

/// A constant below one: `mantissa` · 2^-(32 + `shift`), within 5e-10 of its value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "bake", derive(databake::Bake), databake(path = whisking))]
pub struct FineFactor {
    /// Magnitude 2^30 to 2^31 − 1, or zero.
    pub mantissa: i32,
    /// −1 to 30.
    pub shift: i32,
}

/// Constants below one with a scale in common: `mantissas` · 2^-(16 + `shift`).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "bake", derive(databake::Bake), databake(path = whisking))]
pub struct Factors<const K: usize> {
    /// Magnitude of the largest 2^14 to 2^15 − 1, or all zero.
    pub mantissas: [i16; K],
    /// −1 to 30.
    pub shift: i32,
}

/// The most by which an `i32` can be shifted and rounded.
const SHIFT_MAX: i32 = 30;

/// The largest power of two, as its exponent from `least` to [`SHIFT_MAX`], by
/// which `value` may be multiplied and stay within `limit` when rounded.
fn scale(value: f64, limit: f64, least: i32) -> i32 {
    let mut shift = least;
    while shift < SHIFT_MAX
        && libm::round(libm::fabs(value) * libm::exp2(f64::from(shift + 1))) <= limit
    {
        shift += 1;
    }
    shift
}

/// x / 2^shift, rounded to the nearest; halves upwards.
#[inline]
const fn rounded(x: i32, shift: u32) -> i32 {
    // No carry out of 32 bits: what is shifted is at most 2^30.
    (x + ((1 << shift) >> 1)) >> shift
}

/// `x` scaled by a constant below one: 2^-`shift`, −1 at least.
#[inline]
const fn lowered(x: i32, shift: i32) -> i32 {
    if shift < 0 {
        x << 1
    } else {
        rounded(x, shift.unsigned_abs())
    }
}

/// x / 2^shift, rounded to the nearest.
#[inline]
const fn nearest(x: i64, shift: u32) -> i32 {
    ((x + (1 << (shift - 1))) >> shift) as i32
}

/// x · 2^shift, saturated at ±4.
#[inline]
fn raised(x: i32, shift: u32) -> i32 {
    let limit = SATURATED >> shift;
    x.clamp(-limit, limit - 1) << shift
}

impl Factor {
    const LEAST: i32 = -30;

    pub(super) fn new(value: f64) -> Self {
        // The casts saturate, and take a NaN to zero.
        let shift = scale(value * 65_536.0, 32_767.0, Self::LEAST);
        let mantissa = libm::round(value * libm::exp2(f64::from(16 + shift)));
        Self {
            mantissa: mantissa as i16,
            shift,
        }
    }

    /// The product with `x` in Q28, in Q28.
    #[inline]
    pub(super) fn times(self, x: i32) -> i32 {
        match self.shift {
            0.. => rounded(by_half(x, self.mantissa), self.shift.unsigned_abs()),
            _ => raised(by_half(x, self.mantissa), self.shift.unsigned_abs()),
        }
    }

    /// The product with an integer, in Q28; saturates at ±4.
    #[inline]
    pub(super) fn times_integer(self, x: i32) -> i32 {
        // As the mantissa is at least 2^14, nothing beyond this is within ±4 ...
        let bits = (4 + self.shift).clamp(0, 29).unsigned_abs();
        let within = x.clamp(-(1 << bits), 1 << bits);
        // ... and 2^30 is left for the product, whose steps are 2^-26 then.
        raised(by_half(within << (30 - bits), self.mantissa), 2)
    }
}

impl FineFactor {
    pub(super) fn new(value: f64) -> Self {
        let shift = scale(value * 4_294_967_296.0, 2_147_483_647.0, -1);
        let mantissa = libm::round(value * libm::exp2(f64::from(32 + shift)));
        Self {
            mantissa: mantissa as i32,
            shift,
        }
    }

    /// The product with `x`.
    #[inline]
    pub(super) const fn times(self, x: i32) -> i32 {
        if self.shift < 0 {
            // A share of more than half must not take more than all.
            return nearest(x as i64 * self.mantissa as i64, 31);
        }
        rounded(high(x, self.mantissa), self.shift.unsigned_abs())
    }

    /// What this share takes of `x`, and what is left of `carry` below the last bit.
    #[inline]
    pub(super) fn of(self, x: i32, carry: i64) -> (i32, i64) {
        let bits = (32 + self.shift).unsigned_abs();
        let product = i64::from(x) * i64::from(self.mantissa) + carry;
        let step = product >> bits;
        (step as i32, product - (step << bits))
    }
}

impl<const K: usize> Factors<K> {
    pub(super) fn new(values: [f64; K]) -> Self {
        let largest = values
            .iter()
            .fold(0.0, |m, c| libm::fmax(m, libm::fabs(*c)));
        let shift = scale(largest * 65_536.0, 32_767.0, -1);
        let power = libm::exp2(f64::from(16 + shift));
        Self {
            mantissas: values.map(|c| libm::round(c * power) as i16),
            shift,
        }
    }

    /// Σ x_k c_k.
    #[inline]
    pub(super) fn dot(&self, x: [i32; K]) -> i32 {
        let sum = x
            .iter()
            .zip(self.mantissas)
            .map(|(x, m)| by_constant(*x, m))
            .sum();
        lowered(sum, self.shift)
    }
}
