//! The log-sigmoid σ(u) = 1 / (1 + exp(−u)) in single precision and in fixed
//! point, each with a bound that a test holds.
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

/// Fraction bits of a drive in fixed point.
pub(super) const DRIVE_BITS: u32 = 12;
/// Fraction bits of an output in fixed point.
pub(super) const OUTPUT_BITS: u32 = 15;

/// Cells of the table to each unit of drive, as a power of two.
const CELL_BITS: u32 = 4;
/// Where the table ends, as a power of two: 1 − σ(16) is 1.1e-7.
const REACH_BITS: u32 = 4;
const CELLS: usize = 1 << (CELL_BITS + REACH_BITS);
const PLACE_BITS: u32 = DRIVE_BITS - CELL_BITS;

/// 2¹⁵ σ(−i/16), rounded.
static FALLING: [u16; CELLS + 1] = table();

const fn table() -> [u16; CELLS + 1] {
    let mut table = [0; CELLS + 1];
    let mut i = 0;
    while i <= CELLS {
        let e = exp_neg(i as f64 / (1 << CELL_BITS) as f64);
        table[i] = (e / (1.0 + e) * (1 << OUTPUT_BITS) as f64 + 0.5) as u16;
        i += 1;
    }
    table
}

/// exp(−x) for 0 ≤ x ≤ 16, for the compiler: the series of exp(x/32), twenty
/// terms of which leave less than 1e-24, squared five times and inverted.
const fn exp_neg(x: f64) -> f64 {
    let y = x / 32.0;
    let mut sum = 1.0;
    let mut n = 20.0;
    while n >= 1.0 {
        sum = 1.0 + sum * y / n;
        n -= 1.0;
    }
    let mut i = 0;
    while i < 5 {
        sum *= sum;
        i += 1;
    }
    1.0 / sum
}

/// σ of a drive in units of 2⁻¹², in units of 2⁻¹⁵ (0 to 2¹⁵): within 8e-5,
/// namely 4.7e-5 for the straight lines (h² max|σ″| / 8) and 1.5e-5 each for
/// the rounding of the table and of the result.
#[inline]
pub(super) fn logistic_fixed(drive: i32) -> i32 {
    let size = drive.unsigned_abs();
    // One before the last: the cell's end must exist.
    let cell = ((size >> PLACE_BITS) as usize).min(CELLS - 1);
    let place = i32::from(size as u8);
    let (start, end) = (i32::from(FALLING[cell]), i32::from(FALLING[cell + 1]));
    // Rounded to nearest; the last cells are flat, so a drive beyond the reach
    // gets the same.
    let falling = start - (((start - end) * place + 128) >> PLACE_BITS);
    if drive < 0 {
        falling
    } else {
        (1 << OUTPUT_BITS) - falling
    }
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

    #[test]
    fn fixed_point_is_within_its_bound() {
        let mut worst = 0.0_f64;
        for drive in -200_000..=200_000_i32 {
            let found = f64::from(logistic_fixed(drive)) / 32768.0;
            worst = worst.max((found - exact(f64::from(drive) / 4096.0)).abs());
        }
        assert!((4e-5..8e-5).contains(&worst), "{worst:e}");
    }

    #[test]
    fn fixed_point_never_falls_and_keeps_its_ends() {
        let mut last = 0;
        for drive in -80_000..=80_000_i32 {
            let y = logistic_fixed(drive);
            assert!(y >= last, "{drive}");
            last = y;
        }
        assert_eq!(logistic_fixed(i32::MIN), 0);
        assert_eq!(logistic_fixed(i32::MAX), 1 << 15);
        assert_eq!(logistic_fixed(0), 1 << 14);
    }
}
