//! The number formats of the tick. Each equation is written once over [`Real`]: f64 is the
//! reference, f32 is for processors with an FPU, [`Fix`] for those without.

mod fix;
mod float;
mod row;

use core::fmt::Debug;
use core::ops::{Add, Mul, Neg, Sub};

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::Bounded;

pub use fix::{Factor, Factors, FineFactor, Fix};
pub use row::FactorRow;

/// A constant of the tick as a configuration holds it, which goes over a wire and into
/// memory as plain data.
pub trait Constant: Copy + Debug + PartialEq + Serialize + DeserializeOwned + 'static {}
impl<T: Copy + Debug + PartialEq + Serialize + DeserializeOwned + 'static> Constant for T {}

/// Which number format it is, with the number by which a PC knows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FormatCode {
    /// `f32`.
    Single = 1,
    /// `f64`.
    Double = 2,
    /// [`Fix`].
    Fixed = 3,
}

/// A number format of the tick.
///
/// States lie within ±4. Constants of the tick have types of their own, because in fixed point a
/// small constant keeps its digits only with a scale of its own. Stated errors of functions are the
/// largest absolute ones in f32 and in [`Fix`], measured by the tests of this crate.
pub trait Real:
    Constant
    + Bounded
    + Default
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
{
    /// A factor; relative error up to 3.1e-5 in fixed point.
    type Coefficient: Constant + Bounded;

    /// A factor below one whose error would accumulate over many ticks.
    type Fine: Constant + Bounded;

    /// `K` factors below one that are used together and share a scale.
    type Row<const K: usize>: Constant + Bounded;

    /// Rounding error that a long sum carries along.
    type Carry: Copy + Debug + Default + PartialEq + 'static;

    /// Which it is.
    const FORMAT: FormatCode;
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// 2.
    const TWO: Self;

    /// The nearest representable number. For configurations, not for the tick.
    fn from_f64(value: f64) -> Self;

    /// The same from single precision; in fixed point without a number of double precision in
    /// between, which links two kilobytes where a core has none.
    #[inline]
    fn from_f32(value: f32) -> Self {
        Self::from_f64(value.into())
    }

    /// The same value in f64. For reports, not for the tick.
    fn to_f64(self) -> f64;

    /// The nearest factor. For configurations, not for the tick.
    fn coefficient(value: f64) -> Self::Coefficient;

    /// The nearest fine factor. For configurations, not for the tick.
    fn fine(value: f64) -> Self::Fine;

    /// The nearest row. For configurations, not for the tick.
    fn row<const K: usize>(values: [f64; K]) -> Self::Row<K>;

    /// The product with a fine factor.
    fn times_fine(self, factor: Self::Fine) -> Self;

    /// Half of the number.
    fn halved(self) -> Self;

    /// The number, limited to ±1/2 in a format whose sums would otherwise overflow.
    #[inline]
    fn within_half(self) -> Self {
        self
    }

    /// The product of a number below 2 with one within ±4 of which four digits are enough.
    #[inline]
    fn rough(self, other: Self) -> Self {
        self * other
    }

    /// Σ x_k c_k, which must stay within ±8.
    fn dot<const K: usize>(x: [Self; K], row: &Self::Row<K>) -> Self;

    /// The product with a factor.
    fn times(self, factor: Self::Coefficient) -> Self;

    /// `counts` times a factor.
    fn from_counts(counts: i32, factor: Self::Coefficient) -> Self;

    /// `value` / 2^24.
    fn from_q24(value: i32) -> Self;

    /// `code`/8191 for |code| ≤ 8191: a signed 14-bit reading, normalised.
    fn from_code(code: i16) -> Self;

    /// The value in Q24, rounded towards zero or downwards; saturates, and NaN gives 0.
    fn to_q24(self) -> i32;

    /// Adds `increment` and the rounding error of the last addition, so that a
    /// sum of many small steps stays accurate.
    fn accumulate(&mut self, carry: &mut Self::Carry, increment: Self);

    /// Decays by the fraction `share`, however small: `carry` holds the rounding error.
    fn decay(&mut self, carry: &mut Self::Carry, share: Self::Fine);

    /// Whether |x| ≤ `limit`, which a NaN is not.
    fn is_within(self, limit: Self) -> bool;

    /// Whether no product of these wraps around: of numbers within ±2 none does, and in
    /// floats none at all.
    #[inline]
    fn multiplies<const K: usize>(_numbers: &[[Self; 2]; K]) -> bool {
        true
    }

    /// tanh(2x)/2 for |x| ≤ 1.5; error 6e-7.
    fn half_tanh(self) -> Self;

    /// exp(−x²) for |x| ≤ 1.5, the value at 1.5 beyond; error 6e-7.
    fn exp_neg_square(self) -> Self;

    /// 1 − 1/√(1 + x) for |x| ≤ 1/16; error 5e-6.
    fn one_minus_inv_sqrt(self) -> Self;

    /// (x, y)/r, or `None` where r is zero (in f32 and f64 below 1e-15); error 2e-7.
    fn unit(x: Self, y: Self) -> Option<[Self; 2]>;

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

    /// The nearest number in `lo..=hi`; NaN gives `lo`, which is safe for every caller.
    #[inline]
    fn clamp(self, lo: Self, hi: Self) -> Self {
        if self > lo {
            if self < hi { self } else { hi }
        } else {
            lo
        }
    }
}
