//! Which numbers a constant may be.

use proptest::prelude::*;
use whisking::motor::Duty;
use whisking::{Bound, Bounded, Factor, FactorRow, Factors, FineFactor, Fix, Real};

const SHARE: Bound = Bound::positive(0);
const EIGHT: Bound = Bound::signed(3);

#[test]
fn constants_within_their_bounds_are_let_through() {
    fn check<R: Real>() {
        for value in [0.0, 1e-6, 0.07, 0.99, 1.0, -0.3, 7.9] {
            assert!(R::from_f64(value).lies_within(EIGHT), "{value}");
            assert!(R::coefficient(value).lies_within(EIGHT), "{value}");
        }
        for value in [0.0, 1e-6, 0.07, 0.99] {
            assert!(R::fine(value).lies_within(SHARE), "{value}");
            assert!(R::row([value, value / 7.0]).lies_within(SHARE), "{value}");
            assert!(R::row([value, -value]).lies_within(EIGHT), "{value}");
        }
    }
    check::<f32>();
    check::<f64>();
    check::<Fix>();
    assert!((-70_000_i32).lies_within(Bound::signed(17)));
    assert!(i32::MIN.lies_within(Bound::signed(31)));
    assert!(65_535_u16.lies_within(Bound::positive(16)));
    assert!(u32::MAX.lies_within(Bound::positive(32)));
    assert!(255_u8.lies_within(Bound::positive(8)));
    assert!(Duty::from_q15(-32_767).lies_within(Bound::signed(0)));
    assert!([1.0, 0.5].lies_within(SHARE));
}

#[test]
fn what_is_no_number_negative_or_too_large_is_refused() {
    for bad in [f32::NAN, -f32::NAN, f32::INFINITY, -1e-9, 1.001] {
        assert!(
            !bad.lies_within(SHARE) && !f64::from(bad).lies_within(SHARE),
            "{bad}"
        );
        assert!(![0.5, bad].lies_within(SHARE), "{bad}");
        assert!(!FactorRow([0.5, bad]).lies_within(SHARE), "{bad}");
    }
    assert!(!Fix(-1).lies_within(SHARE));
    assert!(!Fix((1 << 28) + 1).lies_within(SHARE));
    assert!(!Fix(i32::MIN).lies_within(SHARE));
    // Mantissas and shifts that no factor has.
    for (mantissa, shift) in [(1, 0), (i16::MIN, 0), (20_000, 31), (20_000, -31)] {
        let factor = Factor { mantissa, shift };
        assert!(!factor.lies_within(Bound::signed(30)), "{factor:?}");
    }
    for (mantissa, shift) in [(1, 0), (i32::MIN, 0), (1 << 30, 31), (1 << 30, -2)] {
        let factor = FineFactor { mantissa, shift };
        assert!(!factor.lies_within(EIGHT), "{factor:?}");
    }
    for (last, shift) in [(i16::MIN, 0), (5, 31), (5, -2)] {
        let mantissas = [20_000, last];
        let factors = Factors { mantissas, shift };
        assert!(!factors.lies_within(EIGHT), "{factors:?}");
    }
    assert!(!Fix::row([0.5, -0.25]).lies_within(SHARE));
    assert!(!Fix::coefficient(5.0).lies_within(SHARE));
    assert!(!Fix::coefficient(-0.5).lies_within(SHARE));
    assert!(!Fix::fine(-0.5).lies_within(SHARE));
    assert!(!(-1_i32).lies_within(Bound::positive(30)));
    assert!(!(-1_i16).lies_within(Bound::positive(30)));
    assert!(!257_i32.lies_within(Bound::signed(8)));
    assert!(!257_u32.lies_within(Bound::signed(8)));
    assert!(!1_u8.lies_within(Bound::positive(-1)));
    assert!(!Duty::from_q15(-1).lies_within(SHARE));
}

proptest! {
    /// Whatever its bits: a float lies within a bound if its value does.
    #[test]
    fn floats_are_judged_as_by_their_values(bits in any::<u64>(), power in -2..=30_i8) {
        let most = f64::from(power).exp2();
        let is_within = |x: f64| x.abs() <= most;
        let (double, single) = (f64::from_bits(bits), f32::from_bits(bits as u32));
        for bound in [Bound::signed(power), Bound::positive(power)] {
            let sign = |is_negative: bool| bound.signed || !is_negative;
            let found = double.lies_within(bound);
            prop_assert_eq!(found, is_within(double) && sign(double.is_sign_negative()));
            let found = single.lies_within(bound);
            let expected = is_within(single.into()) && sign(single.is_sign_negative());
            prop_assert_eq!(found, expected);
        }
    }
}
