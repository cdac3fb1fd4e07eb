//! The number formats the equations run in. Each equation is written once over
//! [`Real`]; f64 is the reference, f32 is what a part with an FPU runs.

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Mul, Neg, Sub};

use crate::math;

/// A number format of the tick.
///
/// The functions are those the equations need, each on the range in which it
/// is used; their errors are largest absolute errors there, in f32, measured
/// by the tests of this crate.
pub trait Real:
    Copy
    + Debug
    + Default
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + 'static
{
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// ½.
    const HALF: Self;
    /// Limit of an oscillator's states, ψ_lim = 1.5 (BIOTACT section III-B).
    const PSI_LIMIT: Self;
    /// Squared radius below which an oscillator counts as standing at its origin.
    const ORIGIN: Self;

    /// The nearest representable number. For configurations, not for the tick.
    fn from_f64(value: f64) -> Self;

    /// The same value in f64. For reports, not for the tick.
    fn to_f64(self) -> f64;

    /// `value` / 2^24.
    fn from_q24(value: i32) -> Self;

    /// The nearest multiple of 1/32767, limited to ±1; NaN gives 0.
    fn to_q15(self) -> i16;

    /// Muscle drive W = (tanh 2x + 1)/2 (BIOTACT eq. 6) for |x| ≤ 1.5; error 2e-7.
    fn drive(self) -> Self;

    /// exp(−x²), the loss of force with contraction (BIOTACT eq. 8), for |x| ≤ 1.5;
    /// beyond that the value at 1.5; error 4e-7.
    fn exp_neg_square(self) -> Self;

    /// 1/√x for x of [`Self::ORIGIN`] and above; relative error 2e-7.
    fn inv_sqrt(self) -> Self;

    /// |x|.
    #[inline]
    fn abs(self) -> Self {
        if self < Self::ZERO { -self } else { self }
    }

    /// The larger of the two; `other` if `self` is NaN.
    #[inline]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }

    /// The nearest number in `lo..=hi`; NaN gives `lo`, the side on which
    /// every caller is safe.
    #[inline]
    fn clamp(self, lo: Self, hi: Self) -> Self {
        if self > lo {
            if self < hi { self } else { hi }
        } else {
            lo
        }
    }
}

impl Real for f32 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const HALF: Self = 0.5;
    const PSI_LIMIT: Self = 1.5;
    const ORIGIN: Self = 1e-30;

    #[inline]
    fn from_f64(value: f64) -> Self {
        value as f32
    }

    #[inline]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }

    #[inline]
    fn from_q24(value: i32) -> Self {
        value as f32 * (1.0 / 16_777_216.0)
    }

    #[inline]
    fn to_q15(self) -> i16 {
        if self.is_nan() {
            return 0;
        }
        let scaled = Real::clamp(self, -1.0, 1.0) * 32_767.0;
        // The offset makes truncation a rounding.
        ((scaled + 32_768.5) as i32 - 32_768) as i16
    }

    #[inline]
    fn drive(self) -> Self {
        math::drive(self)
    }

    #[inline]
    fn exp_neg_square(self) -> Self {
        math::exp_neg_square(self)
    }

    #[inline]
    fn inv_sqrt(self) -> Self {
        math::inv_sqrt(self)
    }
}

impl Real for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const HALF: Self = 0.5;
    const PSI_LIMIT: Self = 1.5;
    const ORIGIN: Self = 1e-30;

    #[inline]
    fn from_f64(value: f64) -> Self {
        value
    }

    #[inline]
    fn to_f64(self) -> f64 {
        self
    }

    #[inline]
    fn from_q24(value: i32) -> Self {
        f64::from(value) / 16_777_216.0
    }

    #[inline]
    fn to_q15(self) -> i16 {
        (self as f32).to_q15()
    }

    #[inline]
    fn drive(self) -> Self {
        0.5 * libm::tanh(2.0 * self) + 0.5
    }

    #[inline]
    fn exp_neg_square(self) -> Self {
        let x = Real::clamp(self, -1.5, 1.5);
        libm::exp(-x * x)
    }

    #[inline]
    fn inv_sqrt(self) -> Self {
        1.0 / libm::sqrt(self)
    }
}

#[cfg(test)]
mod tests {
    use super::Real;

    #[test]
    fn clamp_takes_nan_to_the_low_side() {
        assert_eq!(Real::clamp(f32::NAN, -2.0, 3.0), -2.0);
        assert_eq!(Real::clamp(f32::INFINITY, -2.0, 3.0), 3.0);
        assert_eq!(Real::clamp(f64::NEG_INFINITY, -2.0, 3.0), -2.0);
        assert_eq!(Real::clamp(1.0_f32, -2.0, 3.0), 1.0);
    }

    #[test]
    fn q15_rounds_and_saturates_on_both_sides() {
        let cases = [
            (0.0, 0),
            (1.0, 32_767),
            (-1.0, -32_767),
            (7.0, 32_767),
            (f32::NEG_INFINITY, -32_767),
            (f32::NAN, 0),
            (1.4 / 32_767.0, 1),
            (-1.4 / 32_767.0, -1),
            (-1.6 / 32_767.0, -2),
        ];
        for (value, code) in cases {
            assert_eq!(Real::to_q15(value), code, "{value}");
            assert_eq!(Real::to_q15(f64::from(value)), code, "{value}");
        }
    }
}
