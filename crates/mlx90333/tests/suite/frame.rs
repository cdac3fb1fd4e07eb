//! The decoder against frames written by hand, and against the encoder.

use mlx90333::{ByteOrder, Decoder, Faults, Frame, FrameError, Mode, SumRule, Word, encode};
use proptest::prelude::*;
use proptest::sample::select;

const MODES: [Mode; 2] = [Mode::AlphaBeta, Mode::Xyz];

/// The rules that look at B7.
const SUMMING: &[SumRule] = SumRule::ALL.split_last().unwrap().1;

/// alpha = 0x1234, beta = 0xABCD: 0x34 + 0x12 + 0xCD + 0xAB = 0x1BE.
const ALPHA_BETA: [u8; 8] = [0xFF, 0x34, 0x12, 0xCD, 0xAB, 0x00, 0x00, 0xBE];

/// Any word, the ends of the range more often than their share.
fn word() -> impl Strategy<Value = Word> {
    prop_oneof![
        4 => any::<u16>(),
        1 => select(vec![0, 1, 0x00FF, 0x7FFF, 0x8000, 0xFF00, 0xFFFF]),
    ]
    .prop_map(Word::new)
}

fn xyz(words: [Word; 3], rule: SumRule) -> [u8; 8] {
    encode::words(words.map(Word::raw), Decoder::with(Mode::Xyz, rule))
}

fn pair() -> impl Strategy<Value = (Word, Word)> {
    let stuck =
        |pair: &(Word, Word)| matches!((pair.0.raw(), pair.1.raw()), (0, 0) | (0xFFFF, 0xFFFF));
    (word(), word()).prop_filter("a stuck line", move |pair| !stuck(pair))
}

#[test]
fn alpha_beta_by_hand() {
    let frame = Decoder::new().decode(&ALPHA_BETA).unwrap();
    let words = [frame.first, frame.second].map(Word::raw);
    assert_eq!((words, frame.third), ([0x1234, 0xABCD], None));
}

#[test]
fn high_bytes_first_by_hand() {
    let bytes = [0xFF, 0x12, 0x34, 0xAB, 0xCD, 0x00, 0x00, 0xBE];
    let decoder = Decoder {
        byte_order: ByteOrder::Big,
        ..Decoder::new()
    };
    assert_eq!(decoder.decode(&bytes), Decoder::new().decode(&ALPHA_BETA));
    let words = |decoder| encode::words([0x1234, 0xABCD, 0], decoder);
    assert_eq!(words(decoder), bytes);
    assert_eq!(words(Decoder::new()), ALPHA_BETA);
    // An error word too: 0x0200 is the clamp of the rough offset, 0x0002 unknown.
    let bytes = encode::words([0x1234, 0xABCD, 0x0200], decoder);
    assert_eq!(bytes[5..7], [0x02, 0x00]);
    let faults = FrameError::Sensor(Faults::new(0x0200));
    assert_eq!(decoder.decode(&bytes), Err(faults));
}

#[test]
fn xyz_by_hand() {
    // 0x1BE + 0x78 + 0x56 = 0x28C.
    let bytes = [0xFF, 0x34, 0x12, 0xCD, 0xAB, 0x78, 0x56, 0x8C];
    let decoder = Decoder::with(Mode::Xyz, SumRule::SumB1B6);
    let frame = decoder.decode(&bytes).unwrap();
    let words = [frame.first, frame.second].map(Word::raw);
    let third = Some(Word::new(0x5678));
    assert_eq!((words, frame.third), ([0x1234, 0xABCD], third));
    // The same bytes in the other mode carry an error word.
    let faults = FrameError::Sensor(Faults::new(0x5678));
    assert_eq!(Decoder::new().decode(&bytes), Err(faults));
}

#[test]
fn each_rule_by_hand() {
    let by_rule = [
        (SumRule::SumB1B6, 0xBE),
        (SumRule::SumB0B6, 0xBD),
        (SumRule::ComplementB1B6, 0x41),
        (SumRule::ComplementB0B6, 0x42),
    ];
    for (rule, expected) in by_rule {
        let decoder = Decoder::with(Mode::AlphaBeta, rule);
        for found in 0..=0xFF {
            let mut bytes = ALPHA_BETA;
            bytes[7] = found;
            let result = decoder.decode(&bytes);
            if found == expected {
                assert_eq!(result.unwrap().first.raw(), 0x1234, "{rule:?}");
            } else {
                assert_eq!(result, Err(FrameError::BadSum { expected, found }));
            }
            let ignores = Decoder::with(Mode::AlphaBeta, SumRule::Ignore);
            assert!(ignores.decode(&bytes).is_ok());
        }
    }
}

#[test]
fn silent_and_stuck_lines_under_every_rule() {
    for mode in MODES {
        for rule in SumRule::ALL {
            let decoder = Decoder::with(mode, rule);
            assert_eq!(decoder.decode(&[0xFF; 8]), Err(FrameError::NoSensor));
            assert_eq!(decoder.decode(&[0x00; 8]), Err(FrameError::LineLow));
        }
    }
}

/// A line held low after the first byte keeps the sum; one let go does not, unless noise
/// makes it so.
#[test]
fn words_of_a_stuck_line_are_no_reading() {
    let held_low = [0xFF, 0, 0, 0, 0, 0, 0, 0];
    let let_go = [0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0, 0, 0xFC];
    for mode in MODES {
        for bytes in [held_low, let_go] {
            let decoded = Decoder::with(mode, SumRule::SumB1B6).decode(&bytes);
            assert_eq!(decoded, Err(FrameError::StuckWords));
        }
    }
    let corner =
        |a, b| encode::alpha_beta(Word::new(a), Word::new(b), Faults::NONE, SumRule::SumB1B6);
    for (a, b) in [(0, 1), (0, 0xFFFF), (0xFFFF, 0), (0xFFFF, 0xFFFE)] {
        assert!(Decoder::new().decode(&corner(a, b)).is_ok());
    }
}

#[test]
fn reports_come_in_the_documented_order() {
    // Bad start, bad sum and an error word at once; then the last two.
    let mut bytes = [0x7F, 1, 2, 3, 4, 5, 6, 0x99];
    let decoder = Decoder::new();
    assert_eq!(decoder.decode(&bytes), Err(FrameError::BadStart(0x7F)));
    bytes[0] = 0xFF;
    let (expected, found) = (21, 0x99);
    let bad_sum = FrameError::BadSum { expected, found };
    assert_eq!(decoder.decode(&bytes), Err(bad_sum));
    bytes[7] = 21;
    let faults = FrameError::Sensor(Faults::new(0x0605));
    assert_eq!(decoder.decode(&bytes), Err(faults));
}

proptest! {
    #[test]
    fn what_was_encoded_is_decoded(
        (x, y) in pair(),
        z in word(),
        bits in 1_u16..,
        rule in select(&SumRule::ALL[..]),
    ) {
        let of = |mode, bytes| Decoder::with(mode, rule).decode(&bytes);
        let faults = Faults::new(bits);
        let decoded = of(Mode::AlphaBeta, encode::alpha_beta(x, y, Faults::NONE, rule));
        prop_assert_eq!(decoded, Ok(Frame { first: x, second: y, third: None }));
        let decoded = of(Mode::Xyz, xyz([x, y, z], rule));
        prop_assert_eq!(decoded, Ok(Frame { first: x, second: y, third: Some(z) }));
        let decoded = of(Mode::AlphaBeta, encode::alpha_beta(x, z, faults, rule));
        prop_assert_eq!(decoded, Err(FrameError::Sensor(faults)));
    }

    /// Any eight bytes have an answer, and a frame that passes is one that the
    /// encoder would have sent.
    #[test]
    fn what_passes_encodes_back(mut bytes: [u8; 8], good_sum: bool) {
        bytes[0] |= 0xF0;
        for &rule in SUMMING {
            if good_sum {
                bytes[7] = rule.expected(&bytes).unwrap();
            }
            for mode in MODES {
                match Decoder::with(mode, rule).decode(&bytes) {
                    Ok(Frame { first, second, third }) => prop_assert_eq!(
                        xyz([first, second, third.unwrap_or_default()], rule), bytes),
                    Err(FrameError::BadStart(start)) => {
                        prop_assert!(start == bytes[0] && start != 0xFF);
                    }
                    Err(FrameError::BadSum { found, .. }) =>
                        prop_assert!(found == bytes[7] && !good_sum),
                    Err(FrameError::Sensor(faults)) => prop_assert!(
                        mode == Mode::AlphaBeta && faults.bits() == u16::from_le_bytes([bytes[5], bytes[6]])),
                    Err(error) => prop_assert_eq!(error, FrameError::NoSensor),
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// Bits in the order of the wire; all bursts of up to eight at all places, a single bit among
    /// them. One of the first byte leaves no start, any other no sum.
    #[test]
    fn every_short_burst_is_caught(x in word(), y in word(), z in word()) {
        for &rule in SUMMING {
            let frames = [
                (Mode::AlphaBeta, encode::alpha_beta(x, y, Faults::NONE, rule)),
                (Mode::Xyz, xyz([x, y, z], rule)),
            ];
            for (mode, sent) in frames {
                let decoder = Decoder::with(mode, rule);
                for (burst, place) in (1_u64..=0xFF).flat_map(|b| (0..=56).map(move |p| (b, p))) {
                    let bytes = (u64::from_be_bytes(sent) ^ (burst << place)).to_be_bytes();
                    let error = decoder.decode(&bytes).unwrap_err();
                    let is_start = matches!(error, FrameError::BadStart(_));
                    let is_sum = matches!(error, FrameError::BadSum { .. });
                    let is_named = if bytes[0] == 0xFF { is_sum } else { is_start };
                    prop_assert!(is_named, "{rule:?} {burst:#x} at {place}: {error:?}");
                }
            }
        }
    }
}
