//! The log-sigmoid σ(u) = 1 / (1 + exp(−u)) in single precision, with a
//! bound that a test holds.
//!
//! Only the falling half is worked out, σ(−|u|); the other is one less that,
//! so that σ(u) + σ(−u) is one to a rounding.

/// Beyond this drive exp(−|u|) leaves the normal numbers; σ has long been flat.
const MAX_DRIVE: f32 = 87.0;

/// σ(u), f32: within 1.5e-7 of the exact value for every u, which is two and
/// a half units in the last place of one; NaN gives that of −87, nearly nought.
///
/// exp(−|u|) = 2⁻ⁿ 2^f with |f| ≤ ½, and 2^f by the first seven terms of its
/// series, whose rest is below (ln 2 / 2)⁷ / 7! = 1.2e-7 relative.
#[inline]
pub(super) fn logistic(u: f32) -> f32 {
    #[allow(clippy::manual_clamp, reason = "these two turn NaN into a number")]
    let u = u.max(-MAX_DRIVE).min(MAX_DRIVE);
    let bits = u.abs() * core::f32::consts::LOG2_E;
    let whole = (bits + 0.5) as u32;
    let y = (whole as f32 - bits) * core::f32::consts::LN_2;
    let series = 1.0
        + y * (1.0
            + y * (1.0 / 2.0
                + y * (1.0 / 6.0 + y * (1.0 / 24.0 + y * (1.0 / 120.0 + y * (1.0 / 720.0))))));
    // At most 126 halvings: the exponent field stays above zero.
    let power = f32::from_bits((127 - whole) << 23);
    let e = series * power;
    let falling = e / (1.0 + e);
    if u < 0.0 { falling } else { 1.0 - falling }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exact(u: f64) -> f64 {
        1.0 / (1.0 + (-u).exp())
    }

    #[test]
    fn single_precision_is_within_its_bound() {
        let mut worst = 0.0_f64;
        for i in -2_000_000..=2_000_000_i32 {
            let u = i as f32 * 5e-5;
            worst = worst.max((f64::from(logistic(u)) - exact(f64::from(u))).abs());
        }
        // Bounded on both sides: it can neither decay nor be mismeasured.
        assert!((4e-8..1.5e-7).contains(&worst), "{worst:e}");
    }

    #[test]
    fn far_out_it_is_flat_and_small_values_keep_their_digits() {
        for (u, y) in [(1e30, 1.0), (f32::INFINITY, 1.0), (f32::MAX, 1.0)] {
            assert_eq!(logistic(u), y);
            assert!(logistic(-u) < 1e-36 && logistic(-u) > 0.0);
        }
        assert!(logistic(f32::NAN) < 1e-36);
        let relative = f64::from(logistic(-60.0)) / exact(-60.0) - 1.0;
        // 60 · log2 e in f32 is off by up to 2⁻¹⁸ of a power of two.
        assert!(relative.abs() < 4e-6, "{relative:e}");
    }
}
