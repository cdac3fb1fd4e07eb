//! The signed duty: folding, conversion from floats, scaling to a timer.

use proptest::prelude::*;
use whisking::motor::{Duty, Fault};

#[test]
fn q15_is_symmetric() {
    assert_eq!(Duty::from_q15(i16::MIN).q15(), -32_767);
    assert_eq!(Duty::from_q15(i16::MIN).magnitude(), 32_767);
    assert_eq!(Duty::from_q15(32_767), Duty::FULL);
    assert_eq!(Duty::from_q15(0), Duty::ZERO);
    assert_eq!(Duty::default(), Duty::ZERO);
}

#[test]
fn floats_at_the_edges() {
    for (fraction, q15) in [
        (f32::NAN, 0),
        (-f32::NAN, 0),
        (0.0, 0),
        (-0.0, 0),
        (1.0, 32_767),
        (-1.0, -32_767),
        (1.000_001, 32_767),
        (f32::INFINITY, 32_767),
        (f32::NEG_INFINITY, -32_767),
        (f32::MIN_POSITIVE, 0),
        (0.5, 16_384),
        (-0.5, -16_384),
        (0.25, 8_192),
    ] {
        assert_eq!(Duty::from_f32(fraction).q15(), q15, "{fraction}");
    }
}

#[test]
fn fault_numbers_are_stable() {
    let all = [
        (Fault::Pin, 1),
        (Fault::Pwm, 2),
        (Fault::InvalidHall(0), 3),
        (Fault::InvalidHall(7), 4),
        (Fault::SkippedSector, 5),
        (Fault::Stall, 6),
        (Fault::Following, 7),
        (Fault::Runaway, 8),
        (Fault::Encoder, 9),
        (Fault::Travel, 10),
        (Fault::Heat, 11),
        (Fault::Homing, 12),
        (Fault::LostCounts, 13),
    ];
    for (fault, code) in all {
        assert_eq!(fault.code(), code);
        assert_eq!(Fault::from_code(code), Some(fault));
        let says = format!("motor fault {code}:");
        assert!(fault.to_string().starts_with(&says));
    }
    assert_eq!(Fault::from_code(0), None);
    assert_eq!(Fault::from_code(14), None);
}

proptest! {
    #[test]
    fn floats_round_to_nearest(fraction in -1.2_f32..1.2) {
        let exact = f64::from(fraction).clamp(-1.0, 1.0) * 32_767.0;
        let error = (f64::from(Duty::from_f32(fraction).q15()) - exact).abs();
        prop_assert!(error <= 0.504, "{error}");
    }
}
