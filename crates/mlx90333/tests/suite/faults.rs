//! The error word, bit by bit, against the table of known bits.

use mlx90333::{Decoder, Faults, FrameError, SumRule, Word, encode};

/// Written out once more, from the table of the protocol.
const TABLE: [(u16, &str); 10] = [
    (0x0004, "ADC monitor"),
    (0x0008, "ADC saturated"),
    (0x0010, "gain too low"),
    (0x0020, "gain too high"),
    (0x0040, "norm too low"),
    (0x0080, "field too low"),
    (0x0100, "field too high"),
    (0x0200, "rough offset clamp"),
    (0x0800, "dead zone alpha"),
    (0x8000, "dead zone beta"),
];
fn through_a_frame(bits: u16) -> Faults {
    let (alpha, beta) = (Word::new(0x2468), Word::MID);
    let bytes = encode::alpha_beta(alpha, beta, Faults::new(bits), SumRule::default());
    assert_eq!(u16::from_le_bytes([bytes[5], bytes[6]]), bits);
    match Decoder::new().decode(&bytes) {
        Err(FrameError::Sensor(faults)) => faults,
        other => panic!("{other:?}"),
    }
}

#[test]
fn each_bit_is_named_or_kept_as_unknown() {
    for bits in (0..16).map(|place| 1 << place) {
        let faults = through_a_frame(bits);
        assert_eq!(faults.bits(), bits);
        if let Some((_, name)) = TABLE.iter().find(|(known, _)| *known == bits) {
            assert_eq!(faults.unknown(), 0);
            assert_eq!(faults.to_string(), *name);
            assert!(faults.named().eq([(Faults::new(bits), *name)]));
        } else {
            assert_eq!(faults.unknown(), bits);
            assert_eq!(faults.named().count(), 0);
            assert_eq!(faults.to_string(), format!("unknown 0x{bits:04x}"));
            let both = faults | Faults::GAIN_TOO_HIGH;
            assert_eq!(both.to_string(), format!("gain too high, {faults}"));
        }
    }
    assert!(Faults::NONE.is_empty() && !through_a_frame(0xFFFF).is_empty());
    assert_eq!(Faults::NONE.to_string(), "none");
}
