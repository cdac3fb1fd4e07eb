//! Constants of the tick as words.

use whisking::motor::Duty;
use whisking::{AsWords, Bound, Factor, FineFactor, Fix, Real, WordRow};

const SHARE: Bound = Bound::positive(0);
const EIGHT: Bound = Bound::signed(3);

fn again<T: AsWords + PartialEq + std::fmt::Debug>(constant: T, bound: Bound) {
    assert_eq!(T::from_words(constant.words(), bound), Some(constant));
}

#[test]
fn constants_come_back_from_their_words() {
    for value in [0.0, 1e-6, 0.07, 0.99, 1.0, -0.3, 7.9] {
        again(value as f32, EIGHT);
        again(value, EIGHT);
        again(<Fix as Real>::coefficient(value), EIGHT);
        again(Fix::from_f64(value), EIGHT);
        assert!((Fix::coefficient(value).value() - value).abs() <= 3.1e-5 * value.abs());
        assert!((Fix::from_f64(value).value() - value).abs() < 4e-9);
    }
    for value in [0.0, 1e-6, 0.07, 0.99, -0.3] {
        again(Fix::fine(value), EIGHT);
        assert!((Fix::fine(value).value() - value).abs() <= 5e-10);
    }
    again(-70_000_i32, Bound::signed(32));
    again(65_535_u16, Bound::positive(32));
    again(u32::MAX, Bound::positive(32));
    again(true, SHARE);
    again(Duty::from_q15(-32_767), Bound::signed(0));
    let mut row = Fix::row([0.5, -0.25]);
    let words = [0, 1].map(|n| row.words(n));
    let other = Fix::row([0.01, 0.02]);
    row = other;
    assert!((0..2).all(|n| row.set_words(n, words[n], EIGHT)));
    assert_eq!([row.value(0), row.value(1)], [0.5, -0.25]);
}

#[test]
fn what_is_no_number_or_out_of_bounds_is_none() {
    for bad in [
        f32::NAN,
        -f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        -1e-9,
        1.001,
    ] {
        assert_eq!(f32::from_words(bad.words(), SHARE), None, "{bad}");
        let bad = f64::from(bad);
        assert_eq!(f64::from_words(bad.words(), SHARE), None, "{bad}");
    }
    assert_eq!(Fix::from_words(Fix(-1).words(), SHARE), None);
    assert_eq!(Fix::from_words(Fix((1 << 28) + 1).words(), SHARE), None);
    // A mantissa that no factor has, a shift that cannot be shifted by, and a size of 5.
    let factor = |mantissa: i32, shift: i32| [mantissa, shift].map(i32::cast_unsigned);
    for words in [
        factor(1, 0),
        factor(-32_768, 0),
        factor(20_000, 31),
        factor(1 << 20, 0),
    ] {
        assert_eq!(Factor::from_words(words, EIGHT), None, "{words:?}");
        assert_eq!(FineFactor::from_words(words, EIGHT), None, "{words:?}");
    }
    assert_eq!(
        Factor::from_words(Fix::coefficient(5.0).words(), SHARE),
        None
    );
    assert_eq!(FineFactor::from_words(factor(1 << 30, -2), EIGHT), None);
    assert_eq!(u16::from_words([65_536, 0], Bound::positive(32)), None);
    assert_eq!(i32::from_words([u32::MAX, 0], Bound::positive(32)), None);
    assert_eq!(bool::from_words([2, 0], SHARE), None);
    assert_eq!(Duty::from_words([0xFFFF_8000, 0], Bound::signed(0)), None);
    assert_eq!(Duty::from_words([0xFFFF_FFFF, 0], SHARE), None);
}
