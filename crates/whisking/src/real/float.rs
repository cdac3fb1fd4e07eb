//! f32 and f64 as number formats of the tick.

use super::{FactorRow, FormatCode, Real};
use crate::math::single;

/// Squared length below which a vector has no direction.
const ORIGIN: f32 = 1e-30;

macro_rules! float {
    ($float:ident) => {
        type Coefficient = Self;
        type Fine = Self;
        type Row<const K: usize> = FactorRow<Self, K>;
        type Carry = Self;
        const ZERO: Self = 0.0;
        const ONE: Self = 1.0;
        const TWO: Self = 2.0;

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

        fn row<const K: usize>(values: [f64; K]) -> FactorRow<Self, K> {
            FactorRow(values.map(Self::coefficient))
        }

        fn fine(value: f64) -> Self {
            value as $float
        }

        #[inline]
        fn times_fine(self, factor: Self) -> Self {
            self * factor
        }

        #[inline]
        fn halved(self) -> Self {
            0.5 * self
        }

        #[inline]
        fn times(self, factor: Self) -> Self {
            self * factor
        }

        #[inline]
        fn dot<const K: usize>(x: [Self; K], row: &FactorRow<Self, K>) -> Self {
            x.iter().zip(&row.0).map(|(x, c)| x * c).sum()
        }

        #[inline]
        fn from_counts(counts: i32, factor: Self) -> Self {
            counts as $float * factor
        }

        #[inline]
        fn from_q24(value: i32) -> Self {
            value as $float * (1.0 / 16_777_216.0)
        }

        #[inline]
        fn abs(self) -> Self {
            $float::abs(self)
        }

        #[inline]
        fn is_within(self, limit: Self) -> bool {
            $float::abs(self) <= limit
        }

        #[inline]
        fn from_code(code: i16) -> Self {
            Self::from(code) * (1.0 / 8191.0)
        }

        #[inline]
        fn to_q24(self) -> i32 {
            (self * 16_777_216.0) as i32
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
        fn decay(&mut self, carry: &mut Self, share: Self) {
            let step = -share * *self;
            self.accumulate(carry, step);
        }
    };
}

impl Real for f32 {
    const FORMAT: FormatCode = FormatCode::Single;
    float!(f32);

    #[inline]
    fn half_tanh(self) -> Self {
        single::half_tanh(self)
    }

    #[inline]
    fn exp_neg_square(self) -> Self {
        single::exp_neg_square(self)
    }

    #[inline]
    fn one_minus_inv_sqrt(self) -> Self {
        single::one_minus_inv_sqrt(self)
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
    const FORMAT: FormatCode = FormatCode::Double;
    float!(f64);

    #[inline]
    fn half_tanh(self) -> Self {
        0.5 * libm::tanh(2.0 * self)
    }

    #[inline]
    fn exp_neg_square(self) -> Self {
        let x = Real::clamp(self, -1.5, 1.5);
        libm::exp(-x * x)
    }

    #[inline]
    fn one_minus_inv_sqrt(self) -> Self {
        let r = libm::sqrt(1.0 + self);
        self / (r * (1.0 + r))
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
    fn q24_saturates_and_takes_nan_to_nothing() {
        for (value, q24) in [
            (0.5, 1 << 23),
            (-1.0, -1 << 24),
            (1e9, i32::MAX),
            (f32::NEG_INFINITY, i32::MIN),
            (f32::NAN, 0),
        ] {
            assert_eq!(value.to_q24(), q24);
            assert_eq!(f64::from(value).to_q24(), q24);
        }
    }
}
