//! Packets: what comes from the module.

use crate::answer::Answer;
use crate::flags::Flags;
use crate::record::TickRecord;
use crate::words::{PACKET_BYTES, PACKET_WORDS, words};

/// What comes from the module.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Packet {
    /// One whisker in one tick.
    Record(TickRecord),
    /// What became of a request.
    Answer(Answer),
}

impl Packet {
    /// What these words say.
    pub fn from_words(words: [u32; PACKET_WORDS]) -> Self {
        if Flags::from_bits((words[4] >> 16) as u16).contains(Flags::ANSWER) {
            Self::Answer(Answer::from_words(words))
        } else {
            Self::Record(TickRecord::from_words(words))
        }
    }

    /// What these bytes say.
    pub fn from_bytes(bytes: &[u8; PACKET_BYTES]) -> Self {
        Self::from_words(words(bytes))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{Packet, TickRecord};

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
            if let Packet::Record(TickRecord { .. }) = Packet::from_words(words) {
                prop_assert_eq!(again, words);
            } else {
                prop_assert_eq!(&again[..4], &words[..4]);
            }
        }
    }
}
