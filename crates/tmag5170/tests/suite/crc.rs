//! The check bits against frames from outside, another implementation, and wrong bits.

use crate::common::crc_by_shifting;
use proptest::prelude::*;
use tmag5170::{Command, CommandError, Register, Reply, ReplyError, check, crc4};

#[test]
fn published_replies() {
    // On an oscilloscope in TI's forum, thread 1374120: just powered up (S10), something in
    // SYS_STATUS (S9), an error (S3).
    let reply = Reply::decode(&0x6000_008C_u32.to_be_bytes()).unwrap();
    assert_eq!(reply.status.bits(), 0x608);
    assert_eq!(reply.trusted(), Err(ReplyError::Restarted));
    // birkler's component calls this one valid.
    assert_eq!(check(&0xE000_008A_u32.to_be_bytes()), Ok(()));
}

#[test]
fn a_published_reply_whose_command_was_rejected() {
    // TI's forum, thread 1199728, of two channels: E0 0F F1 A7 came where 6 was computed; thread 1358585 says
    // that an inverted last bit means wrong check bits in the command.
    let bytes = [0xE0, 0x0F, 0xF1, 0xA7];
    assert_eq!(crc4(&bytes), 6);
    assert_eq!(check(&bytes), Err(ReplyError::Rejected));
    assert_eq!(check(&[0xE0, 0x0F, 0xF1, 0xA6]), Ok(()));
}

#[test]
fn which_wrong_bits_are_found() {
    let good = u32::from_be_bytes(Command::read(Register::X).bytes());
    let verdict = |wrong: u32| check(&(good ^ wrong).to_be_bytes());
    let rejected = (0..32).filter(|bit| verdict(1 << bit) == Err(ReplyError::Rejected));
    assert_eq!(rejected.count(), 3);
    for burst in 1..8 {
        assert!((0..30).all(|at| verdict(burst << at).is_err()));
    }
    let pairs = (0..32).flat_map(|one| (0..one).map(move |two| (1 << one) | (1 << two)));
    let missed = pairs.clone().filter(|&wrong| verdict(wrong).is_ok());
    assert_eq!((pairs.count(), missed.count()), (496, 21));
}

proptest! {
    #[test]
    fn two_implementations_agree(frame: [u8; 4]) {
        prop_assert_eq!(crc4(&frame), crc_by_shifting(frame));
    }

    #[test]
    fn a_wrong_bit_is_always_found(frame: [u8; 4], bit in 0_u32..32) {
        let [b0, b1, b2, b3] = frame;
        let good = [b0, b1, b2, (b3 & 0xF0) | crc4(&frame)];
        let wrong = (u32::from_be_bytes(good) ^ (1_u32 << bit)).to_be_bytes();
        prop_assert!(check(&wrong).is_err());
        prop_assert!(Reply::decode(&wrong).is_err());
        prop_assert_eq!(Command::decode(&wrong), Err(CommandError::BadCrc));
    }

    #[test]
    fn any_four_bytes_have_an_answer(bytes: [u8; 4]) {
        let _ = Command::decode(&bytes);
        let _ = Reply::decode(&bytes).map(Reply::trusted);
    }
}
