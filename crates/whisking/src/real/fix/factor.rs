//! The fixed-point format and its factors.

use serde::{Deserialize, Serialize};

use crate::math::product::{by_half, high};
use crate::real::row::array;

/// Bits after the binary point.
pub(super) const FRACTION: u32 = 28;
/// Where products and readings saturate: 4.
pub(super) const SATURATED: i32 = 4 << FRACTION;

/// A factor with a scale of its own: `mantissa` · 2^-(16 + `shift`), within 3.1e-5 of its value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Factor {
    /// Magnitude 2^14 to 2^15 − 1, or zero.
    pub mantissa: i16,
    /// −30 to 30.
    pub shift: i32,
}

/// A factor below one: `mantissa` · 2^-(32 + `shift`), within 5e-10 of its value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct FineFactor {
    /// Magnitude 2^30 to 2^31 − 1, or zero.
    pub mantissa: i32,
    /// −1 to 30.
    pub shift: i32,
}

/// Factors below one with a common scale: `mantissas` · 2^-(16 + `shift`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Factors<const K: usize> {
    /// Magnitude of the largest 2^14 to 2^15 − 1, or all zero.
    #[serde(with = "array")]
    pub mantissas: [i16; K],
    /// −1 to 30.
    pub shift: i32,
}

/// The largest shift of an `i32` that can be rounded.
pub(super) const SHIFT_MAX: i32 = 30;

/// The exponent, `least` to [`SHIFT_MAX`], of the largest power of two with
/// which the product of `value`, rounded, stays within `limit`.
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
    // What is added is at most 2^29, and |x| at most 2^30 unless its bits were flipped.
    x.wrapping_add((1 << shift) >> 1) >> shift
}

/// x / 2^shift, rounded to the nearest, for a shift of −1 or more.
#[inline]
const fn lowered(x: i32, shift: i32) -> i32 {
    if shift < 0 {
        x << 1
    } else {
        rounded(x, shift.unsigned_abs())
    }
}

/// x · 2^shift, saturated at ±4.
#[inline]
fn raised(x: i32, shift: u32) -> i32 {
    let limit = SATURATED >> shift;
    // `clamp` could panic, for all that the compiler knows of the limits.
    x.max(-limit).min(limit - 1) << shift
}

impl Factor {
    pub(super) fn new(value: f64) -> Self {
        // Casts saturate, and turn NaN into zero.
        let shift = scale(value * 65_536.0, 32_767.0, -SHIFT_MAX);
        let mantissa = libm::round(value * libm::exp2(f64::from(16 + shift))) as i16;
        // As of a fine one.
        let is_normal = mantissa.unsigned_abs() >= 1 << 14;
        Self {
            mantissa: if is_normal { mantissa } else { 0 },
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
        // The mantissa is at least 2^14, so a larger `x` gives a product beyond ±4 ...
        let bits = (4 + self.shift).clamp(0, 29).unsigned_abs();
        let within = x.clamp(-(1 << bits), 1 << bits);
        // ... and this leaves 2^30 for the product, in steps of 2^-26.
        raised(by_half(within << (30 - bits), self.mantissa), 2)
    }
}

impl FineFactor {
    pub(super) fn new(value: f64) -> Self {
        let shift = scale(value * 4_294_967_296.0, 2_147_483_647.0, -1);
        let mantissa = libm::round(value * libm::exp2(f64::from(32 + shift))) as i32;
        // Of no number in this format is a smaller share as much as half of the last bit.
        let is_normal = mantissa.unsigned_abs() >= 1 << 30;
        Self {
            mantissa: if is_normal { mantissa } else { 0 },
            shift,
        }
    }

    #[inline]
    pub(super) const fn times(self, x: i32) -> i32 {
        if self.shift < 0 {
            // 64 bits, so that a share close to one takes no more than all of `x`.
            return ((x as i64 * self.mantissa as i64 + (1 << 30)) >> 31) as i32;
        }
        rounded(high(x, self.mantissa), self.shift.unsigned_abs())
    }

    /// This share of `x`, and the new `carry`: the bits below the last one.
    #[inline]
    pub(super) fn of(self, x: i32, carry: i64) -> (i32, i64) {
        let bits = (32 + self.shift).unsigned_abs();
        let product = (i64::from(x) * i64::from(self.mantissa)).wrapping_add(carry);
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

    #[inline]
    pub(super) fn dot(&self, x: [i32; K]) -> i32 {
        let sum = x
            .iter()
            .zip(self.mantissas)
            .map(|(x, m)| by_half(*x, m))
            .fold(0, i32::wrapping_add);
        lowered(sum, self.shift)
    }
}
