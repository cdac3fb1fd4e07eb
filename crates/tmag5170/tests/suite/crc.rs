//! The check bits against frames from outside, two other implementations, and wrong bits.

use crate::common::crc_by_shifting;
use proptest::prelude::*;
use tmag5170::{ChannelPair, Command, CommandError, Register, Reply, ReplyError, check, crc4};

/// Frames that others have published: the command that switches the CRC off (SBASAF4,
/// 7.5.2.5), a reply on an oscilloscope (TI's forum, thread 1374120), one that birkler's
/// component calls valid.
const PUBLISHED: [u32; 3] = [0x0F00_0407, 0x6000_008C, 0xE000_008A];

/// The `crc` crate with the data sheet's polynomial and preset.
fn crc_of_the_crate(frame: [u8; 4]) -> u8 {
    let algorithm = crc::Algorithm::<u8> {
        width: 4,
        poly: 0x3,
        init: 0xF,
        refin: false,
        refout: false,
        xorout: 0,
        check: 0,
        residue: 0,
    };
    // The crate takes a static.
    let algorithm: &'static crc::Algorithm<u8> = Box::leak(Box::new(algorithm));
    let [b0, b1, b2, b3] = frame;
    crc::Crc::<u8>::new(algorithm).checksum(&[b0, b1, b2, b3 & 0xF0])
}

#[test]
fn published_frames() {
    for frame in PUBLISHED {
        assert_eq!(
            u32::from(crc4(&frame.to_be_bytes())),
            frame & 0xF,
            "{frame:#x}"
        );
    }
}

#[test]
fn a_published_pair_whose_command_was_rejected() {
    // TI's forum, thread 1199728: E0 0F F1 A7 came where 6 was computed; thread 1358585 says
    // that an inverted last bit tells of wrong check bits in the command.
    let bytes = [0xE0, 0x0F, 0xF1, 0xA7];
    assert_eq!(crc4(&bytes), 6);
    assert_eq!(ChannelPair::decode(&bytes), Err(ReplyError::Rejected));
    // Without that, small fields of both axes.
    let pair = ChannelPair::decode(&[0xE0, 0x0F, 0xF1, 0xA6]).unwrap();
    assert_eq!(pair.fields().map(|field| field.code() / 16), [-6, 1]);
    assert_eq!(pair.status.count(), 6);
}

#[test]
fn of_lost_lines_neither_is_a_frame() {
    assert_eq!(check(&[0xFF; 4]), Err(ReplyError::NoSensor));
    assert_eq!(check(&[0x00; 4]), Err(ReplyError::LineLow));
}

#[test]
fn three_single_bits_read_as_a_rejected_command() {
    let good = Command::read(Register::X).bytes();
    let rejected = (0..32)
        .filter(|bit| {
            let wrong = (u32::from_be_bytes(good) ^ (1_u32 << bit)).to_be_bytes();
            check(&wrong) == Err(ReplyError::Rejected)
        })
        .count();
    assert_eq!(rejected, 3);
}

#[test]
fn short_bursts_are_found_wherever_they_are() {
    let good = u32::from_be_bytes(Command::read(Register::X).bytes());
    for burst in 1..8_u32 {
        for at in 0..30 {
            assert!(check(&(good ^ (burst << at)).to_be_bytes()).is_err());
        }
    }
}

#[test]
fn of_496_pairs_of_wrong_bits_21_are_missed() {
    let good = u32::from_be_bytes(Command::read(Register::X).bytes());
    let pairs = (0..32).flat_map(|one| (0..one).map(move |two| (1 << one) | (1 << two)));
    let missed = pairs
        .clone()
        .filter(|wrong| check(&(good ^ wrong).to_be_bytes()).is_ok());
    assert_eq!((pairs.clone().count(), missed.count()), (496, 21));
}

proptest! {
    #[test]
    fn three_implementations_agree(frame: [u8; 4]) {
        prop_assert_eq!(crc4(&frame), crc_by_shifting(frame));
        prop_assert_eq!(crc4(&frame), crc_of_the_crate(frame));
    }

    /// Of any frame, good to begin with.
    #[test]
    fn a_wrong_bit_is_always_found(frame: [u8; 4], bit in 0_u32..32) {
        let [b0, b1, b2, b3] = frame;
        let good = [b0, b1, b2, (b3 & 0xF0) | crc4(&frame)];
        let wrong = (u32::from_be_bytes(good) ^ (1_u32 << bit)).to_be_bytes();
        prop_assert!(check(&wrong).is_err());
        prop_assert!(Reply::decode(&wrong).is_err());
        prop_assert!(ChannelPair::decode(&wrong).is_err());
        prop_assert_eq!(Command::decode(&wrong), Err(CommandError::BadCrc));
    }

    #[test]
    fn any_four_bytes_have_an_answer(bytes: [u8; 4]) {
        let _ = check(&bytes);
        let _ = Command::decode(&bytes);
        if let Ok(reply) = Reply::decode(&bytes) {
            let _ = reply.trusted();
        }
        if let Ok(pair) = ChannelPair::decode(&bytes) {
            let _ = pair.trusted(tmag5170::DataType::Xy);
            let _ = pair.fields();
        }
    }
}
