//! A reading's scaled forms against f64, over every word.

use mlx90333::Word;

#[test]
#[expect(clippy::float_cmp, reason = "the ends are exact by contract")]
fn normalised_ends_are_exact() {
    assert_eq!(Word::new(0xFFFC).normalised(), 1.0);
    assert_eq!(Word::new(0xFFFF).normalised(), 1.0);
    assert_eq!(Word::new(0).normalised(), -1.0);
    assert_eq!(Word::new(4).normalised(), -1.0);
    assert_eq!(Word::new(0x8000).normalised(), 0.0);
    assert_eq!(Word::MID.normalised(), 0.0);
}

#[test]
fn codes() {
    for (raw, code, signed) in [
        (0, 0, -8192),
        (3, 0, -8192),
        (4, 1, -8191),
        (0x7FFF, 8191, -1),
        (0x8000, 8192, 0),
        (0x8004, 8193, 1),
        (0xFFFF, 16383, 8191),
    ] {
        assert_eq!(Word::new(raw).code14(), code);
        assert_eq!(Word::new(raw).signed14(), signed);
        assert_eq!(Word::new(raw).raw(), raw);
    }
}

#[test]
fn normalised_of_every_word() {
    for raw in 0..=u16::MAX {
        let exact = ((f64::from(raw / 4) - 8192.0) / 8191.0).max(-1.0);
        let found = Word::new(raw).normalised();
        assert!((-1.0..=1.0).contains(&found), "{raw}");
        assert!((f64::from(found) - exact).abs() <= 8e-8, "{raw}");
    }
}

#[test]
fn angle_of_every_word() {
    for full_scale in [360.0_f32, 90.0, -60.0, 0.1] {
        for raw in 0..=u16::MAX {
            let exact = f64::from(raw) / 65535.0 * f64::from(full_scale);
            let found = f64::from(Word::new(raw).angle_deg(full_scale));
            let error = (found - exact).abs();
            assert!(error <= 1.2e-7 * exact.abs(), "{raw} {full_scale}");
        }
    }
}

#[test]
fn every_word_returns_without_its_lower_bits() {
    for raw in 0..=u16::MAX {
        let returned = Word::from_normalised(Word::new(raw).normalised());
        assert_eq!(returned.raw(), (raw & !3).max(4));
    }
}

#[test]
fn from_normalised_takes_anything() {
    let raw = |x: f32| Word::from_normalised(x).raw();
    assert_eq!(raw(f32::NAN), 0x8000);
    assert_eq!(raw(-f32::NAN), 0x8000);
    for (x, code) in [(0.0, 8192), (1.0, 16383), (1.5, 16383), (f32::MAX, 16383)] {
        assert_eq!(raw(x), code * 4);
        // The mirror image about 8192.
        assert_eq!(raw(-x), (16384 - code) * 4);
    }
    assert_eq!(raw(f32::INFINITY), 0xFFFC);
    assert_eq!(raw(f32::NEG_INFINITY), 4);
}

#[test]
fn round_trips_are_within_half_a_code_where_they_are_worst() {
    for code in -8191..8191 {
        let half = (f64::from(code) + 0.5) / 8191.0;
        let x = half as f32;
        for x in [x.next_down(), x, x.next_up()] {
            let word = Word::from_normalised(x);
            let steps = (f64::from(word.signed14()) - f64::from(x) * 8191.0).abs();
            // 2⁻¹² of a code: the rounding of x · 8191 may tip what lies at half.
            assert!(steps <= 0.5 + 1.0 / 4096.0, "{x}: {steps} codes off");
            assert_eq!(word.raw() & 3, 0);
        }
    }
}
