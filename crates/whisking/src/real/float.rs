//! f32 and f64 as number formats of the tick.

use super::Real;
use crate::math::single;

/// Squared radius below which an oscillator counts as standing at its origin.
const ORIGIN: f32 = 1e-30;

macro_rules! float {
    ($float:ident) => {
        type Coefficient = Self;
        type Carry = Self;
        const ZERO: Self = 0.0;
        const ONE: Self = 1.0;
        const TWO: Self = 2.0;
        const PSI_LIMIT: Self = 1.5;

        #[inline]
        fn from_f64(value: f64) -> Self {
            value as $float
        }

        #[inline]
        fn to_f64(self) -> f64 {
            f64::from(self)
        }

        #[inline]
        fn coefficient(value: f64) -> Self {
            value as $float
        }

        #[inline]
        fn times(self, factor: Self) -> Self {
            self * factor
        }

        #[inline]
        fn from_counts(counts: i32, factor: Self) -> Self {
            counts as $float * factor
        }

        #[inline]
        fn from_q24(value: i32) -> Self {
            value as $float * (1.0 / 16_777_216.0)
        }

        // Kahan's compensated sum.
        #[inline]
        fn accumulate(&mut self, carry: &mut Self, increment: Self) {
            let step = increment + *carry;
            let sum = *self + step;
            *carry = step - (sum - *self);
            *self = sum;
        }

        #[inline]
        fn relax(&mut self, carry: &mut Self, target: Self, approach: Self) {
            let step = approach * (target - *self);
            self.accumulate(carry, step);
        }
    };
}

impl Real for f32 {
    float!(f32);

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
        single::drive(self)
    }

    #[inline]
    fn exp_neg_square(self) -> Self {
        single::exp_neg_square(self)
    }

    #[inline]
    fn unit(x: Self, y: Self) -> Option<[Self; 2]> {
        let square = x * x + y * y;
        (square > ORIGIN).then(|| {
            let inverse = single::inv_sqrt(square);
            [x * inverse, y * inverse]
        })
    }
}

#[allow(
    clippy::cast_lossless,
    reason = "one macro serves both widths; integers are exact in the wider"
)]
impl Real for f64 {
    float!(f64);

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
    fn unit(x: Self, y: Self) -> Option<[Self; 2]> {
        let square = x * x + y * y;
        (square > f64::from(ORIGIN)).then(|| {
            let inverse = 1.0 / libm::sqrt(square);
            [x * inverse, y * inverse]
        })
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

    #[test]
    fn a_share_too_small_for_one_step_still_arrives() {
        let (mut z, mut carry) = (0.75_f32, 0.0);
        // Each step is a thirtieth of the last bit of z.
        for _ in 0..10_000_000 {
            z.relax(&mut carry, 0.0, 2e-9);
        }
        let expected = 0.75 * (-0.02_f64).exp();
        assert!((f64::from(z) - expected).abs() < 1e-6, "{z} {expected}");
    }
}
