//! What a whisker module and a PC say to each other.
//!
//! Upwards go [packets](Packet) of [`PACKET_WORDS`] words of 32 bits: a [`Record`] of each
//! whisker after every tick, once that is asked for, and [answers](Answer). Downwards go
//! [requests](Request) of [`REQUEST_WORDS`] words. Words are little-endian.
//!
//! # Glossary
//!
//! - *sequence*: the number of the tick since the module started; wraps around. Records
//!   that are missing between two were lost.
//! - *protraction*: θ, without unit; the whisker's angle is 100 θ + 50 degrees.
//! - *Q13, Q15, Q24*: integers that stand for n/2^13, n/32767 and n/2^24.
#![cfg_attr(not(test), no_std)]

mod answer;
mod flags;
mod record;
mod request;

pub use answer::{Answer, Status};
pub use flags::Flags;
pub use record::{Record, degrees, q13, unit};
pub use request::{
    Command, REQUEST_BYTES, REQUEST_WORDS, Request, UnknownCommand, Whisker, summed,
};

/// Words of a packet.
pub const PACKET_WORDS: usize = 5;

/// Bytes of a packet.
pub const PACKET_BYTES: usize = PACKET_WORDS * size_of::<u32>();

/// What comes from the module.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Packet {
    /// One whisker in one tick.
    Record(Record),
    /// What became of a request.
    Answer(Answer),
}

impl Packet {
    /// What these words say.
    pub fn from_words(words: [u32; PACKET_WORDS]) -> Self {
        if Flags::from_bits((words[4] >> 16) as u16).contains(Flags::ANSWER) {
            Self::Answer(Answer::from_words(words))
        } else {
            Self::Record(Record::from_words(words))
        }
    }

    /// What these bytes say.
    pub fn from_bytes(bytes: &[u8; PACKET_BYTES]) -> Self {
        Self::from_words(words(bytes))
    }
}

/// The first `N` words of some bytes.
fn words<const N: usize>(bytes: &[u8]) -> [u32; N] {
    let mut words = [0; N];
    for (word, bytes) in words.iter_mut().zip(bytes.as_chunks().0) {
        *word = u32::from_le_bytes(*bytes);
    }
    words
}

/// The halves of a word, the lower one first.
const fn halves(word: u32) -> [u16; 2] {
    [word as u16, (word >> 16) as u16]
}

/// The word of two halves, the lower one first.
const fn word(low: u16, high: u16) -> u32 {
    low as u32 | (high as u32) << 16
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{Packet, Record};

    #[test]
    fn a_record_lies_where_the_page_says() {
        let bytes: Vec<u8> = (1..=20).collect();
        let Packet::Record(record) = Packet::from_bytes(bytes[..].try_into().expect("20 bytes"))
        else {
            panic!("bit 15 of the last half is not set");
        };
        assert_eq!(record.sequence, 0x0403_0201);
        assert_eq!([record.x, record.y], [0x0605, 0x0807]);
        assert_eq!([record.setpoint, record.measured], [0x0A09, 0x0C0B]);
        assert_eq!([record.duty, record.z], [0x0E0D, 0x100F]);
        assert_eq!(record.contact, 0x1211);
        assert_eq!(record.flags.bits(), 0x1413);
    }

    proptest! {
        #[test]
        fn any_words_are_a_packet_that_says_them_again(words in any::<[u32; 5]>()) {
            let again = match Packet::from_words(words) {
                Packet::Record(record) => record.words(),
                Packet::Answer(answer) => answer.words(),
            };
            // The lower half of an answer's last word and its unused bits say nothing.
            if let Packet::Record(Record { .. }) = Packet::from_words(words) {
                prop_assert_eq!(again, words);
            } else {
                prop_assert_eq!(&again[..4], &words[..4]);
            }
        }
    }
}
