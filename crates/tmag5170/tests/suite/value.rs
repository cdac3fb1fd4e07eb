//! Results against values that others compute.

use proptest::prelude::*;
use tmag5170::{Field, Range, Version};

#[test]
fn fields_of_kharims_tests() {
    // Kharim234's decoder, test_convert_raw_magnetic_field_to_miliTeslas: ±150 mT.
    for (code, mt) in [
        (0_i16, 0.0),
        (32767, 149.995_42),
        (-32768, -150.0),
        (16000, 73.242_19),
        (-16000, -73.242_19),
    ] {
        let field = Field::new(code as u16);
        assert_eq!(field.code(), code);
        assert!((field.mt(150.0) - mt).abs() < 2e-5, "{code}");
    }
}

#[test]
fn ranges_of_both_parts() {
    let a1 = [50.0, 25.0, 100.0];
    for (range, mt) in Range::ALL.iter().zip(a1) {
        assert_eq!(range.full_scale_mt(Version::A1), mt);
        assert_eq!(range.full_scale_mt(Version::A2), 3.0 * mt);
    }
}

#[test]
fn a_field_beyond_the_range_is_limited() {
    assert_eq!(Field::from_mt(30.0, 25.0).code(), i16::MAX);
    assert_eq!(Field::from_mt(f32::NEG_INFINITY, 25.0).code(), i16::MIN);
    assert_eq!(Field::from_mt(f32::NAN, 25.0).code(), 0);
}

proptest! {
    #[test]
    fn codes_come_back(code: i16) {
        let field = Field::new(code as u16);
        prop_assert_eq!(Field::from_mt(field.mt(25.0), 25.0), field);
    }

    #[test]
    fn a_field_is_met_within_half_a_code(mt in -25.0_f32..24.99) {
        let met = Field::from_mt(mt, 25.0).mt(25.0);
        prop_assert!((met - mt).abs() <= 0.5001 * 25.0 / 32_768.0);
    }
}
