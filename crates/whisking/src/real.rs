//! The number formats of the tick. Each equation is written once over [`Real`]:
//! f64 is the reference, f32 is for processors with an FPU, [`Fix`] for those
//! without.

mod fix;
mod float;

use core::fmt::Debug;
use core::ops::{Add, Mul, Neg, Sub};

use crate::Elementary;

pub use fix::{Factor, Factors, FineFactor, Fix};

/// A constant of the tick, as configurations hold it; with the feature `bake`
/// one that can be written as Rust source.
#[cfg(not(feature = "bake"))]
pub trait Constant: Copy + Debug + PartialEq + 'static {}
#[cfg(not(feature = "bake"))]
impl<T: Copy + Debug + PartialEq + 'static> Constant for T {}

/// A constant of the tick, as configurations hold it, that can be written as
/// Rust source.
#[cfg(feature = "bake")]
pub trait Constant:
    Copy + Debug + PartialEq + 'static + databake::Bake + databake::BakeSize
{
}
#[cfg(feature = "bake")]
impl<T: Copy + Debug + PartialEq + 'static + databake::Bake + databake::BakeSize> Constant for T {}

/// A number format of the tick.
///
/// States lie within ±4. Constants of the tick have types of their own,
/// because in fixed point a small constant needs a scale of its own to keep
/// its digits.
pub trait Real:
    Constant
    + Elementary
    + Default
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
{
    /// A constant of the tick, to multiply with.
    type Coefficient: Constant;

    /// A constant below one whose error would gather over many ticks.
    type Fine: Constant;

    /// `K` constants below one of the tick that are used together and share a scale.
    type Row<const K: usize>: Constant;

    /// What rounding took from a long sum.
    type Carry: Copy + Debug + Default + PartialEq + 'static;

    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// 2.
    const TWO: Self;

    /// The nearest representable number. For configurations, not for the tick.
    fn from_f64(value: f64) -> Self;

    /// The same value in f64. For reports, not for the tick.
    fn to_f64(self) -> f64;

    /// The nearest coefficient. For configurations, not for the tick.
    fn coefficient(value: f64) -> Self::Coefficient;

    /// The nearest fine constant. For configurations, not for the tick.
    fn fine(value: f64) -> Self::Fine;

    /// The nearest row. For configurations, not for the tick.
    fn row<const K: usize>(values: [f64; K]) -> Self::Row<K>;

    /// The product with a fine constant.
    fn times_fine(self, factor: Self::Fine) -> Self;

    /// Half of it.
    fn halved(self) -> Self;

    /// Itself, or the nearest number within ±1/2 in a format whose sums would
    /// else overflow.
    fn within_half(self) -> Self;

    /// The product, for a number below 2, with one of a magnitude up to 4 of
    /// which four digits do.
    fn rough(self, other: Self) -> Self;

    /// Σ x_k c_k, which must stay within ±8.
    fn dot<const K: usize>(x: [Self; K], row: &Self::Row<K>) -> Self;

    /// The product with a constant.
    fn times(self, factor: Self::Coefficient) -> Self;

    /// `counts` times a constant.
    fn from_counts(counts: i32, factor: Self::Coefficient) -> Self;

    /// `value` / 2^24.
    fn from_q24(value: i32) -> Self;

    /// `code`/8191, the normalised value of a reading of 14 bits about its
    /// middle, |code| ≤ 8191.
    fn from_code(code: i16) -> Self;

    /// The value in Q24, rounded towards zero or downwards; saturates, and NaN
    /// gives 0.
    fn to_q24(self) -> i32;

    /// Adds `increment`, and what rounding took from the last addition: a sum
    /// of many small steps keeps its accuracy.
    fn accumulate(&mut self, carry: &mut Self::Carry, increment: Self);

    /// Loses the share `share` of itself, however small: what rounding takes is
    /// remembered.
    fn decay(&mut self, carry: &mut Self::Carry, share: Self::Fine);

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
