//! Elementary functions of the tick, for each number format.

pub(crate) mod constant;
pub(crate) mod fixed;
pub(crate) mod product;
pub(crate) mod single;

#[cfg(test)]
mod tests {
    use crate::{Fix, Real};

    /// Of x from −1.5 to 1.5.
    fn errors_are_below<R: Real>(half_tanh: f64, exponential: f64) {
        for n in -300_000..=300_000 {
            let x = R::from_f64(f64::from(n) * 5e-6);
            let exact = x.to_f64();
            let error = x.half_tanh().to_f64() - (2.0 * exact).tanh() / 2.0;
            assert!(error.abs() < half_tanh, "{x:?}: {error:e}");
            let error = x.exp_neg_square().to_f64() - (-exact.powi(2)).exp();
            assert!(error.abs() < exponential, "{x:?}: {error:e}");
        }
    }

    #[test]
    fn half_tanh_and_the_exponential_are_within_their_stated_errors() {
        errors_are_below::<f32>(2e-7, 3e-7);
        errors_are_below::<Fix>(6e-7, 6e-7);
    }
}
