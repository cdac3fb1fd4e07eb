//! The elementary functions that every number format brings along.

/// Elementary functions of a number format, over the ranges that the equations
/// need. Stated errors are the largest absolute ones in f32 and in
/// [`Fix`](crate::Fix), measured by the tests of this crate.
pub trait Elementary: Sized {
    /// tanh(2x)/2 for |x| ≤ 1.5; error 6e-7.
    fn half_tanh(self) -> Self;

    /// exp(−x²) for |x| ≤ 1.5, the value at 1.5 beyond; error 6e-7.
    fn exp_neg_square(self) -> Self;

    /// 1 − 1/√(1 + x) for |x| ≤ 1/16; error 5e-6.
    fn one_minus_inv_sqrt(self) -> Self;

    /// (x, y)/r, or `None` where r is zero (in f32 and f64 below 1e-15); error 2e-7.
    fn unit(x: Self, y: Self) -> Option<[Self; 2]>;
}
