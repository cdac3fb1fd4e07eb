//! 32-bit fixed point as a number format of the tick.
//!
//! Numbers have 32 bits. Factors have 16 where a relative error of 3e-5 is
//! harmless, and 31 where it would accumulate over many ticks: a product with
//! 16 bits is cheap on every Cortex-M, one with 32 is not on a Cortex-M0+ (see
//! [`product`](crate::math::product)).

mod bounded;
mod factor;
#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};

use core::ops::{Add, Mul, Neg, Sub};

use factor::{FRACTION, SATURATED};
pub use factor::{Factor, Factors, FineFactor};

use super::{FormatCode, Real};
use crate::math::fixed;
use crate::math::product::{by_top, high_rounded};

#[inline]
const fn product(x: i32, y: i32) -> i32 {
    // Rounded: truncation would bias a sum of many downwards.
    high_rounded(x, y) << 4
}

/// A number from −8 to 8 in steps of 2^-28 (3.7e-9).
///
/// Products with factors and readings saturate at ±4; a sum of two of them
/// cannot wrap around, and no state of the tick comes near that. A state whose bits
/// were flipped may; it wraps around, and is then limited as any other.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Fix(
    /// The value times 2^28.
    pub i32,
);

impl Add for Fix {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self(self.0.wrapping_add(other.0))
    }
}

impl Sub for Fix {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self(self.0.wrapping_sub(other.0))
    }
}

impl Neg for Fix {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(self.0.wrapping_neg())
    }
}

/// Error at most 3.1e-8 for a right operand within ±4.
impl Mul for Fix {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        Self(product(self.0, other.0))
    }
}

impl Real for Fix {
    type Coefficient = Factor;
    type Fine = FineFactor;
    type Row<const K: usize> = Factors<K>;
    /// The bits below the last one of the sum.
    type Carry = i64;
    const FORMAT: FormatCode = FormatCode::Fixed;
    const ZERO: Self = Self(0);
    const ONE: Self = Self(1 << FRACTION);
    const TWO: Self = Self(2 << FRACTION);

    fn from_f64(value: f64) -> Self {
        Self(libm::round(value * f64::from(1 << FRACTION)) as i32)
    }

    fn from_f32(value: f32) -> Self {
        Self(fixed_point(value, FRACTION))
    }

    fn to_f64(self) -> f64 {
        f64::from(self.0) / f64::from(1 << FRACTION)
    }

    fn coefficient(value: f64) -> Factor {
        Factor::new(value)
    }

    fn fine(value: f64) -> FineFactor {
        FineFactor::new(value)
    }

    fn row<const K: usize>(values: [f64; K]) -> Factors<K> {
        Factors::new(values)
    }

    #[inline]
    fn times(self, factor: Factor) -> Self {
        Self(factor.times(self.0))
    }

    #[inline]
    fn times_fine(self, factor: FineFactor) -> Self {
        Self(factor.times(self.0))
    }

    #[inline]
    fn dot<const K: usize>(x: [Self; K], row: &Factors<K>) -> Self {
        Self(row.dot(x.map(|x| x.0)))
    }

    #[inline]
    fn halved(self) -> Self {
        Self(self.0 >> 1)
    }

    #[inline]
    fn within_half(self) -> Self {
        let half = 1 << (FRACTION - 1);
        Self(self.0.clamp(-half, half - 1))
    }

    #[inline]
    fn is_within(self, limit: Self) -> bool {
        self.0.unsigned_abs() <= limit.0.cast_unsigned()
    }

    #[inline]
    fn multiplies<const K: usize>(numbers: &[[Self; 2]; K]) -> bool {
        const TWO: u32 = Fix::TWO.0.cast_unsigned();
        // From −2 to 2 becomes 0 to 4, in two bits fewer than there are.
        let above = |x: &Self| x.0.cast_unsigned().wrapping_add(TWO);
        let all = numbers
            .iter()
            .flatten()
            .map(above)
            .fold(0, |all, x| all | x);
        all < 2 * TWO
    }

    /// Error at most 1.3e-4 of `self` and 3.8e-9.
    #[inline]
    fn rough(self, other: Self) -> Self {
        Self(by_top(self.0 << 2, other.0 << 1) << 1)
    }

    #[inline]
    fn from_counts(counts: i32, factor: Factor) -> Self {
        Self(factor.times_integer(counts))
    }

    #[inline]
    fn from_q24(value: i32) -> Self {
        let limit = SATURATED >> (FRACTION - 24);
        Self(value.clamp(-limit, limit - 1) << (FRACTION - 24))
    }

    #[inline]
    fn from_code(code: i16) -> Self {
        // 2^28/8191 is 32772.0005.
        Self(i32::from(code) * 32_772)
    }

    #[inline]
    fn to_q24(self) -> i32 {
        self.0 >> (FRACTION - 24)
    }

    // Additions are exact; only increments are rounded.
    #[inline]
    fn accumulate(&mut self, _carry: &mut i64, increment: Self) {
        *self = *self + increment;
    }

    #[inline]
    fn decay(&mut self, carry: &mut i64, share: FineFactor) {
        let (step, left) = share.of(self.0, *carry);
        *carry = left;
        self.0 = self.0.wrapping_sub(step);
    }

    #[inline]
    fn half_tanh(self) -> Self {
        Self(fixed::half_tanh(self.0))
    }

    #[inline]
    fn exp_neg_square(self) -> Self {
        Self(fixed::exp_neg_square(self.0))
    }

    #[inline]
    fn one_minus_inv_sqrt(self) -> Self {
        Self(fixed::one_minus_inv_sqrt(self.0))
    }

    #[inline]
    fn unit(x: Self, y: Self) -> Option<[Self; 2]> {
        Some(fixed::unit(x.0, y.0)?.map(Self))
    }
}

/// `value` times 2^`fraction`, rounded half away from zero, limited to what fits; 0 of no number.
fn fixed_point(value: f32, fraction: u32) -> i32 {
    const MANTISSA_BITS: u32 = 23;
    let bits = value.to_bits();
    let biased = (bits >> MANTISSA_BITS) & 0xFF;
    let (leading, exponent) = (u32::from(biased > 0), biased.max(1));
    let mantissa = u64::from((bits % (1 << MANTISSA_BITS)) | (leading << MANTISSA_BITS));
    // By how much it is shifted to the left; 127 is the bias of the exponent.
    let shift = exponent + fraction;
    let magnitude = if let Some(left) = shift.checked_sub(127 + MANTISSA_BITS) {
        // By 8 the leading one is beyond a word: what is more is limited alike.
        mantissa << left.min(8)
    } else {
        let right = 127 + MANTISSA_BITS - shift;
        (((mantissa << 1) >> right.min(62)) + 1) >> 1
    };
    let limit = if value.is_sign_negative() {
        1 << 31
    } else {
        i32::MAX as u64
    };
    let magnitude = magnitude.min(limit) as u32;
    if value.is_nan() {
        0
    } else if value.is_sign_negative() {
        magnitude.wrapping_neg().cast_signed()
    } else {
        magnitude.cast_signed()
    }
}
