//! Elementary functions in single precision.
//!
//! Only additions, multiplications and one division, in a fixed order: a PC
//! and a microcontroller give the same bits. Coefficients are those that
//! `fit/minimax.py` prints.

/// tanh(2x)/2 ≈ x P(x²)/Q(x²), |x| ≤ 1.5.
const TANH_P: [f32; 3] = [0.999_999_9, 0.477_403_25, 0.029_635_241];
const TANH_Q: [f32; 3] = [1.810_733_4, 0.310_634_7, 0.005_177_928];

/// exp(−u) ≈ Σ c_k (u − 1.125)^k, 0 ≤ u ≤ 2.25.
const EXP: [f32; 8] = [
    0.324_652_3,
    -0.324_652_3,
    0.162_330_43,
    -0.054_110_028,
    0.013_510_635,
    -0.002_702_312_5,
    0.000_471_694_37,
    -6.730_117e-5,
];
const EXP_CENTRE: f32 = 1.125;
const EXP_LAST: f32 = 2.25;

/// Muscle drive (tanh 2x + 1)/2 for |x| ≤ 1.5; largest error 2e-7.
#[inline]
pub(crate) fn drive(x: f32) -> f32 {
    let u = x * x;
    let p = (TANH_P[2] * u + TANH_P[1]) * u + TANH_P[0];
    let q = ((TANH_Q[2] * u + TANH_Q[1]) * u + TANH_Q[0]) * u + 1.0;
    x * p / q + 0.5
}

/// exp(−x²) for |x| ≤ 1.5, the value at 1.5 beyond; largest error 4e-7.
#[inline]
pub(crate) fn exp_neg_square(x: f32) -> f32 {
    let u = x * x;
    // Written so that a NaN takes the last value too.
    let u = if u < EXP_LAST { u } else { EXP_LAST };
    let t = u - EXP_CENTRE;
    let mut sum = EXP[7];
    for c in EXP[..7].iter().rev() {
        sum = sum * t + c;
    }
    sum
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
    use super::{drive, exp_neg_square, inv_sqrt};

    fn points() -> impl Iterator<Item = f32> {
        (0..=300_000).map(|i| -1.5 + i as f32 * 1e-5)
    }

    #[test]
    fn drive_is_within_its_stated_error() {
        let worst = points()
            .map(|x| {
                (f64::from(drive(x)) - f64::midpoint(libm::tanh(2.0 * f64::from(x)), 1.0)).abs()
            })
            .fold(0.0, f64::max);
        assert!(worst < 2e-7, "{worst:e}");
    }

    #[test]
    fn exponential_is_within_its_stated_error() {
        let worst = points()
            .map(|x| (f64::from(exp_neg_square(x)) - libm::exp(-f64::from(x).powi(2))).abs())
            .fold(0.0, f64::max);
        assert!(worst < 4e-7, "{worst:e}");
        assert_eq!(exp_neg_square(9.0), exp_neg_square(1.5));
        assert_eq!(exp_neg_square(f32::NAN), exp_neg_square(1.5));
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
