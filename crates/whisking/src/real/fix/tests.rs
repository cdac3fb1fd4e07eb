//! Products, factors and limits of fixed point against f64.

use super::{FRACTION, Factor, Factors, FineFactor, Fix};
use crate::{Bound, Bounded, Real};
use proptest::prelude::*;

const STEP: f64 = 1.0 / (1_u64 << FRACTION) as f64;
/// Relative error of a 16-bit factor.
const FACTOR: f64 = 3.1e-5;

proptest! {
    /// However small a scene's value is, what it comes to is one that a tick takes.
    #[test]
    fn every_share_is_a_number(power in -80.0..0.0_f64) {
        let share = libm::exp2(power);
        prop_assert!(Fix::fine(share).lies_within(Bound::positive(0)));
        prop_assert!(Fix::coefficient(share).lies_within(Bound::positive(0)));
    }

    /// Any bits, and numbers of the format's range, halves of a step among them.
    #[test]
    fn single_precision_is_converted_as_double(bits: u32, near in -9.0..9.0_f32, half in -999..999_i16) {
        let halves = f32::from(half) * (0.5 * STEP as f32);
        for value in [f32::from_bits(bits), near, halves, near * 1e-8] {
            prop_assert_eq!(Fix::from_f32(value), Fix::from_f64(value.into()), "{:e}", value);
        }
    }

    #[test]
    fn products_with_constants_are_close_or_saturate(
        x in -4.0..4.0_f64, power in -18.0..20.0_f64, up in any::<bool>()
    ) {
        let c = if up { libm::exp2(power) } else { -libm::exp2(power) };
        let found = Fix::from_f64(x).times(Fix::coefficient(c)).to_f64();
        let exact = x * c;
        // A factor of one half or more loses the bits by which it shifts up.
        let error = FACTOR * exact.abs() + STEP * (1.0 + 4.0 * c.abs());
        if exact.abs() + error < 4.0 {
            prop_assert!((found - exact).abs() <= error, "{found} {exact}");
        } else {
            prop_assert!(found.abs() <= 4.0 && found.abs() > 4.0 - error - FACTOR * 8.0 && found * exact > 0.0, "{found} {exact}");
        }
    }

    #[test]
    fn products_with_fine_constants_are_the_nearest(x in -7.9..7.9_f64, c in -0.999_999..0.999_999_f64) {
        let found = Fix::from_f64(x).times_fine(Fix::fine(c)).to_f64();
        prop_assert!((found - x * c).abs() <= 3.0 * STEP, "{found} {}", x * c);
    }

    /// Over the range in which a sum of three fits the format.
    #[test]
    fn rows_share_a_scale(x in prop::array::uniform3(-2.9..2.9_f64), c in prop::array::uniform3(-0.9..0.9_f64)) {
        let largest = c.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
        let found = Fix::dot(x.map(Fix::from_f64), &Fix::row(c)).to_f64();
        let exact: f64 = x.iter().zip(c).map(|(x, c)| x * c).sum();
        prop_assert!((found - exact).abs() <= 3.0 * (3.9 * FACTOR * largest + 2.0 * STEP), "{found} {exact}");
    }

    #[test]
    fn products_of_numbers_have_their_stated_error(a in -2.8..2.8_f64, b in -2.8..2.8_f64) {
        let (x, y) = (Fix::from_f64(a), Fix::from_f64(b));
        let error = ((x * y).to_f64() - a * b).abs();
        prop_assert!(error < 4.5e-8, "{error:e}");
        let small = Fix::from_f64(a / 1.41);
        let error = (small.rough(y).to_f64() - small.to_f64() * b).abs();
        prop_assert!(error <= 1.23e-4 * a.abs() / 1.41 + STEP, "{error:e}");
    }

    /// The sum and the difference of any two products or readings fit.
    #[test]
    fn sums_of_two_saturated_numbers_do_not_wrap(a in any::<i32>(), b in any::<i32>()) {
        let per_count = Fix::coefficient(0.37);
        let (x, y) = (Fix::from_counts(a, per_count), Fix::from_counts(b, per_count));
        prop_assert!(((x + y).to_f64() - (x.to_f64() + y.to_f64())).abs() < STEP);
        prop_assert!(((x - y).to_f64() - (x.to_f64() - y.to_f64())).abs() < STEP);
        let x = Fix::from_q24(a);
        prop_assert!((x - y).to_f64().abs() <= 8.0);
    }
}

#[test]
fn constants_keep_their_digits_at_any_scale() {
    for value in [-1.0, 1e-9, 3.3e-5, 5000.0, 1e8] {
        let Factor { mantissa, shift } = Factor::new(value);
        let back = f64::from(mantissa) / libm::exp2(f64::from(16 + shift));
        // Digits below 2^-32 are lost.
        let error = FACTOR.max(2e-14 / f64::abs(value));
        assert!((back / value - 1.0).abs() < error, "{value}: {back}");
    }
    assert_eq!(Factor::new(0.0).mantissa, 0);
    assert_eq!(Factor::new(f64::NAN).mantissa, 0);
    assert_eq!(FineFactor::new(0.0).mantissa, 0);
    assert_eq!(Factors::new([0.0; 2]).mantissas, [0; 2]);
}

#[test]
fn counts_become_numbers_and_saturate() {
    // From the coarsest encoder to the finest: 4 counts per turn, BIOTACT's, and
    // 65,536 with a gear of 1000.
    for counts_per_turn in [4.0, 512.0 * 11.0, 65_536.0, 65_536.0 * 1_000.0] {
        let per_count = 360.0 / counts_per_turn / 100.0;
        let factor = Fix::coefficient(per_count);
        let quarter = Fix::from_counts((counts_per_turn / 4.0) as i32, factor).to_f64();
        assert!((quarter - 0.9).abs() < 3e-5, "{counts_per_turn}: {quarter}");
        for (counts, end) in [(i32::MAX, 4.0), (i32::MIN, -4.0)] {
            let found = Fix::from_counts(counts, factor).to_f64();
            assert!((found - end).abs() < 4e-3 && found.abs() <= 4.0, "{found}");
        }
    }
    assert!(Fix::from_counts(3, Fix::coefficient(1e9)).to_f64() > 3.99);
}
