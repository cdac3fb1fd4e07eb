//! 32-bit fixed point as a number format of the tick.

use core::ops::{Add, Mul, Neg, Sub};

use super::Real;
use crate::math::fixed;

/// Bits behind the point.
const FRACTION: u32 = 29;

/// A number from −4 to 4 in steps of 2^-29 (1.9e-9). Sums and products
/// saturate: nothing wraps around.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Fix(
    /// The value times 2^29.
    pub i32,
);

/// A constant with a scale of its own: `mantissa` · 2^-`shift`, 31 significant bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Factor {
    /// Magnitude 2^30 to 2^31 − 1, or zero.
    pub mantissa: i32,
    /// 0 to 61.
    pub shift: u32,
}

impl Factor {
    const SHIFT_MAX: u32 = 61;

    fn new(value: f64) -> Self {
        let mut shift = 0;
        let mut scaled = value;
        while libm::fabs(scaled) < f64::from(1 << 30) && shift < Self::SHIFT_MAX {
            scaled *= 2.0;
            shift += 1;
        }
        // The cast saturates, and takes a NaN to zero.
        Self {
            mantissa: libm::round(scaled) as i32,
            shift,
        }
    }

    /// The product with `x`, before its shift to the right by [`Self::shift`].
    #[inline]
    fn product(self, x: i32) -> i64 {
        i64::from(x) * i64::from(self.mantissa)
    }

    /// Half of the last bit that a shift leaves.
    #[inline]
    const fn half(self) -> i64 {
        (1 << self.shift) >> 1
    }
}

/// Constants with a scale in common: `mantissas` · 2^-`shift`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Factors<const K: usize> {
    /// Magnitude of the largest 2^28 to 2^29, so that sums of products stay
    /// within 64 bits; all zero if the constants are.
    pub mantissas: [i32; K],
    /// 0 to 59.
    pub shift: u32,
}

impl<const K: usize> Factors<K> {
    fn new(values: [f64; K]) -> Self {
        let largest = values
            .iter()
            .fold(0.0, |m, c| libm::fmax(m, libm::fabs(*c)));
        let mut shift = 0;
        let mut scale = 1.0;
        while largest * scale < f64::from(1 << 28) && shift < 59 {
            scale *= 2.0;
            shift += 1;
        }
        Self {
            mantissas: values.map(|c| libm::round(c * scale) as i32),
            shift,
        }
    }

    /// Half of the last bit that a shift leaves.
    #[inline]
    const fn half(&self) -> i64 {
        (1 << self.shift) >> 1
    }
}

#[inline]
fn saturated(x: i64) -> i32 {
    x.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32
}

impl Add for Fix {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self(self.0.saturating_add(other.0))
    }
}

impl Sub for Fix {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self(self.0.saturating_sub(other.0))
    }
}

impl Neg for Fix {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(self.0.saturating_neg())
    }
}

impl Mul for Fix {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        let product = i64::from(self.0) * i64::from(other.0);
        Self(saturated((product + (1 << (FRACTION - 1))) >> FRACTION))
    }
}

impl Real for Fix {
    type Coefficient = Factor;
    type Row<const K: usize> = Factors<K>;
    /// Bits below the last of the sum.
    type Carry = i64;
    const ZERO: Self = Self(0);
    const HALF: Self = Self(1 << (FRACTION - 1));
    const NEAR: Self = Self(1 << (FRACTION - 4));
    const ONE: Self = Self(1 << FRACTION);
    const TWO: Self = Self(2 << FRACTION);
    const PSI_LIMIT: Self = Self(3 << (FRACTION - 1));

    fn from_f64(value: f64) -> Self {
        Self(libm::round(value * f64::from(1 << FRACTION)) as i32)
    }

    fn to_f64(self) -> f64 {
        f64::from(self.0) / f64::from(1 << FRACTION)
    }

    fn coefficient(value: f64) -> Factor {
        Factor::new(value)
    }

    fn row<const K: usize>(values: [f64; K]) -> Factors<K> {
        Factors::new(values)
    }

    #[inline]
    fn dot<const K: usize>(x: [Self; K], row: &Factors<K>) -> Self {
        let sum: i64 = (0..K)
            .map(|k| i64::from(x[k].0) * i64::from(row.mantissas[k]))
            .sum();
        Self(saturated((sum + row.half()) >> row.shift))
    }

    #[inline]
    fn times(self, factor: Factor) -> Self {
        Self(saturated(
            (factor.product(self.0) + factor.half()) >> factor.shift,
        ))
    }

    #[inline]
    fn from_counts(counts: i32, factor: Factor) -> Self {
        // A factor of at least 4 a count has no use here and saturates.
        match factor.shift.checked_sub(FRACTION) {
            Some(shift) => Self(saturated(factor.product(counts) >> shift)),
            None => Self(if counts == 0 {
                0
            } else {
                saturated(factor.product(counts) << 2)
            }),
        }
    }

    #[inline]
    fn from_q24(value: i32) -> Self {
        Self(saturated(i64::from(value) << (FRACTION - 24)))
    }

    #[inline]
    fn from_code(code: i16) -> Self {
        // 2^29/8191 is 65544.001.
        Self(i32::from(code) * 65_544)
    }

    #[inline]
    fn to_q24(self) -> i32 {
        self.0 >> (FRACTION - 24)
    }

    // Additions are exact; what rounding takes, it takes from the increment.
    #[inline]
    fn accumulate(&mut self, _carry: &mut i64, increment: Self) {
        *self = *self + increment;
    }

    #[inline]
    fn relax(&mut self, carry: &mut i64, target: Self, approach: Factor) {
        let way = approach.product((target - *self).0).saturating_add(*carry);
        let step = way >> approach.shift;
        *carry = way - (step << approach.shift);
        self.0 = saturated(i64::from(self.0) + step);
    }

    #[inline]
    fn drive(self) -> Self {
        Self(fixed::drive(self.0))
    }

    #[inline]
    fn exp_neg_square(self) -> Self {
        Self(fixed::exp_neg_square(self.0))
    }

    #[inline]
    fn lack(self) -> Self {
        Self(fixed::lack(self.0))
    }

    #[inline]
    fn unit(x: Self, y: Self) -> Option<[Self; 2]> {
        Some(fixed::unit(x.0, y.0)?.map(Self))
    }
}

#[cfg(test)]
mod tests {
    use super::{Factor, Fix};
    use crate::Real;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn products_are_the_nearest_or_saturate(x in -4.0..4.0_f64, power in -18.0..10.0_f64, up in any::<bool>()) {
            let c = if up { libm::exp2(power) } else { -libm::exp2(power) };
            let found = Fix::from_f64(x).times(Fix::coefficient(c)).to_f64();
            let exact = (x * c).clamp(-4.0, 4.0);
            prop_assert!((found - exact).abs() <= 2e-9 * (1.0 + libm::fabs(c)), "{} {}", found, exact);
        }

        #[test]
        fn nothing_wraps(a in any::<i32>(), b in any::<i32>()) {
            let (x, y) = (Fix(a), Fix(b));
            let limit = |v: f64| v.clamp(-4.0, Fix(i32::MAX).to_f64());
            prop_assert!(((x + y).to_f64() - limit(x.to_f64() + y.to_f64())).abs() < 1e-12);
            prop_assert!(((x - y).to_f64() - limit(x.to_f64() - y.to_f64())).abs() < 1e-12);
            prop_assert!(((x * y).to_f64() - limit(x.to_f64() * y.to_f64())).abs() < 2e-9);
        }
    }

    #[test]
    fn factors_keep_their_digits_at_any_scale() {
        for value in [1.0, -1.0, 1e-9, 3.3e-5, -0.7, 120.0, 5000.0] {
            let Factor { mantissa, shift } = Factor::new(value);
            let back = f64::from(mantissa) / libm::exp2(f64::from(shift));
            assert!((back / value - 1.0).abs() < 5e-10, "{value}: {back}");
        }
        assert_eq!(Factor::new(0.0).mantissa, 0);
        assert_eq!(Factor::new(f64::NAN).mantissa, 0);
    }

    #[test]
    fn counts_become_numbers_and_saturate() {
        let factor = Fix::coefficient(360.0 / (512.0 * 11.0) / 100.0);
        let quarter = Fix::from_counts(1408, factor).to_f64();
        assert!((quarter - 0.9).abs() < 3e-9, "{quarter}");
        assert_eq!(Fix::from_counts(i32::MIN, factor).0, i32::MIN);
        assert_eq!(Fix::from_counts(3, Fix::coefficient(1e9)).0, i32::MAX);
    }

    #[test]
    fn a_share_too_small_for_one_step_still_arrives() {
        let (mut z, mut carry) = (Fix::from_f64(0.25), 0);
        let approach = Fix::coefficient(2e-9);
        for _ in 0..10_000_000 {
            z.relax(&mut carry, Fix::ZERO, approach);
        }
        let expected = 0.25 * (-0.02_f64).exp();
        assert!(
            (z.to_f64() - expected).abs() < 1e-8,
            "{} {expected}",
            z.to_f64()
        );
    }
}
