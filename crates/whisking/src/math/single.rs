//! Elementary functions in single precision.
//!
//! They use additions, multiplications and one division in a fixed order, so that a PC and a
//! microcontroller give the same bits. `fit/minimax.py` prints the coefficients.

/// tanh(2x)/2 ≈ x P(x²)/Q(x²), |x| ≤ 1.5.
const TANH_P: [f32; 3] = [0.999_999_9, 0.477_403_25, 0.029_635_241];
const TANH_Q: [f32; 3] = [1.810_733_4, 0.310_634_7, 0.005_177_928];

/// exp(−u) ≈ (Σ c_k u^k)², 0 ≤ u ≤ 2.25.
const ROOT_EXP: [f32; 7] = [
    1.0,
    -0.499_999_05,
    0.124_992_3,
    -0.020_810_329,
    0.002_571_712,
    -0.000_236_754_54,
    1.280_848_5e-5,
];
const EXP_LAST: f32 = 2.25;

/// 1 − 1/√(1 + x) ≈ Σ c_k x^(k+1), |x| ≤ 1/16.
const ONE_MINUS_INV_SQRT: [f32; 3] = [0.499_998_44, -0.375_887_4, 0.313_864_86];

/// tanh(2x)/2 for |x| ≤ 1.5; largest error 2e-7.
#[inline]
pub(crate) fn half_tanh(x: f32) -> f32 {
    let u = x * x;
    let p = (TANH_P[2] * u + TANH_P[1]) * u + TANH_P[0];
    let q = ((TANH_Q[2] * u + TANH_Q[1]) * u + TANH_Q[0]) * u + 1.0;
    x * p / q
}

/// exp(−x²) for |x| ≤ 1.5, the value at 1.5 beyond; largest error 3e-7.
///
/// The square of exp(−x²/2), whose polynomial is of one degree less.
#[inline]
pub(crate) fn exp_neg_square(x: f32) -> f32 {
    let u = x * x;
    // In this form NaN gives the last value too.
    let u = if u < EXP_LAST { u } else { EXP_LAST };
    let mut root = ROOT_EXP[6];
    for c in ROOT_EXP[..6].iter().rev() {
        root = root * u + c;
    }
    root * root
}

/// 1 − 1/√(1 + x) for |x| ≤ 1/16; largest error 8e-7.
#[inline]
pub(crate) fn one_minus_inv_sqrt(x: f32) -> f32 {
    let [c0, c1, c2] = ONE_MINUS_INV_SQRT;
    ((c2 * x + c1) * x + c0) * x
}

/// 1/√x for normal x > 0; relative error 2e-7.
///
/// A first guess from the exponent (within 3.5 %), one step of third order
/// (within 4e-5), one of second order (rounding).
#[inline]
pub(crate) fn inv_sqrt(x: f32) -> f32 {
    let guess = f32::from_bits(0x5F37_5A86_u32.wrapping_sub(x.to_bits() >> 1));
    let w = x * guess * guess;
    let y = guess * (1.875 - w * (1.25 - 0.375 * w));
    y + y * (0.5 - 0.5 * x * y * y)
}

#[cfg(test)]
mod tests {
    use super::{exp_neg_square, inv_sqrt, one_minus_inv_sqrt};

    #[test]
    fn beyond_its_range_the_exponential_is_that_at_its_end() {
        assert_eq!(exp_neg_square(9.0), exp_neg_square(1.5));
        assert_eq!(exp_neg_square(f32::NAN), exp_neg_square(1.5));
    }

    #[test]
    fn one_minus_inv_sqrt_is_within_its_stated_error() {
        for n in -6_250..=6_250 {
            let x = f64::from(n) * 1e-5;
            let exact = 1.0 - 1.0 / libm::sqrt(1.0 + x);
            let error = (f64::from(one_minus_inv_sqrt(x as f32)) - exact).abs();
            assert!(error < 8e-7, "{x}: {error:e}");
        }
    }

    #[test]
    fn inverse_root_is_within_its_stated_error_from_the_origin_to_the_corners() {
        let mut x = 1e-30_f32;
        let mut worst = 0.0_f64;
        while x < 5.0 {
            worst = worst.max((f64::from(inv_sqrt(x)) * libm::sqrt(f64::from(x)) - 1.0).abs());
            x *= 1.000_07;
        }
        assert!(worst < 2e-7, "{worst:e}");
    }
}
