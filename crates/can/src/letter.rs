//! Letters from one board of a head to another: requests and what a module sends, in three frames
//! behind all that the head needs. [`Message`](crate::Message) says what an identifier is.
//!
//! | kind | part of | bytes |
//! |---|---|---|
//! | 16 to 18 | a packet, the first to the third | to whom and which letter (5 and 3 bits), seven of the letter |
//! | 20 to 22 | a request, the same | the same |

use crate::{Frame, MAX_NODES};

/// Bytes of a letter.
pub const LETTER_BYTES: usize = PARTS * PART_BYTES;

/// Frames of a letter.
pub const PARTS: usize = 3;

const PART_BYTES: usize = 7;

const PACKET: u16 = 16;
const REQUEST: u16 = 20;

/// Bits of an identifier that all parts of a kind have in common.
const KIND_MASK: u16 = 0b11_1100 << 5;

/// What a letter is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LetterKind {
    /// What a module sends.
    Packet,
    /// What it is asked for.
    Request,
}

/// A letter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Letter {
    /// What it is.
    pub kind: LetterKind,
    /// The other board: whom it is for, or, once it has come, whom it is from.
    pub node: u8,
    /// What it says.
    pub bytes: [u8; LETTER_BYTES],
}

impl Letter {
    /// Identifier and mask by which a controller takes requests alone.
    pub const REQUESTS: [u16; 2] = [REQUEST << 5, KIND_MASK];

    /// Its frames, from node `from`, which counts its letters by `number`. They must go in their
    /// order.
    pub fn frames(&self, from: u8, number: u8) -> [Frame; PARTS] {
        let kind = match self.kind {
            LetterKind::Packet => PACKET,
            LetterKind::Request => REQUEST,
        };
        let parts = self.bytes.as_chunks::<PART_BYTES>().0;
        core::array::from_fn(|n| {
            let [a, b, c, d, e, f, g] = parts.get(n).copied().unwrap_or_default();
            let head = self.node & 31 | number << 5;
            let id = (kind + n as u16) << 5 | u16::from(from & 31);
            Frame::new(id, &[head, a, b, c, d, e, f, g])
        })
    }
}

/// A frame of a letter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// What the letter is.
    pub kind: LetterKind,
    /// Who has sent it.
    pub from: u8,
    /// Whom it is for.
    pub to: u8,
    number: u8,
    place: u8,
    bytes: [u8; PART_BYTES],
}

impl Part {
    /// The part that a frame is; `None`: of no letter.
    pub fn of(frame: &Frame) -> Option<Self> {
        let (kind, from) = (frame.id() >> 5, (frame.id() & 31) as u8);
        let place = kind & 3;
        let &[head, a, b, c, d, e, f, g] = frame.bytes() else {
            return None;
        };
        let kind = match kind & !3 {
            PACKET => LetterKind::Packet,
            REQUEST => LetterKind::Request,
            _ => return None,
        };
        let is_part = usize::from(place) < PARTS && usize::from(from) < MAX_NODES;
        is_part.then_some(Self {
            kind,
            from,
            to: head & 31,
            number: head >> 5,
            place: place as u8,
            bytes: [a, b, c, d, e, f, g],
        })
    }
}

/// Puts letters of one kind together; of one that lacks a part nothing comes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Assembly {
    from: u8,
    number: u8,
    count: u8,
    bytes: [[u8; PART_BYTES]; PARTS],
}

impl Assembly {
    /// Before the first part.
    pub const fn new() -> Self {
        Self {
            from: 0,
            number: 0,
            count: 0,
            bytes: [[0; PART_BYTES]; PARTS],
        }
    }

    /// Takes the next part; the letter that it completes.
    pub fn push(&mut self, part: &Part) -> Option<Letter> {
        let place = (part.from, part.number, part.place);
        if part.place > 0 && place == (self.from, self.number, self.count.wrapping_sub(1)) {
            // One that comes twice: others saw an error in its last bit, which this board did not.
            return None;
        }
        let is_next = place == (self.from, self.number, self.count);
        if part.place == 0 {
            (self.from, self.number, self.count) = (part.from, part.number, 0);
        } else if !is_next {
            self.count = 0;
            return None;
        }
        *self.bytes.get_mut(usize::from(part.place))? = part.bytes;
        self.count += 1;
        if usize::from(self.count) < PARTS {
            return None;
        }
        self.count = 0;
        let mut bytes = [0; LETTER_BYTES];
        for (place, byte) in bytes.iter_mut().zip(self.bytes.as_flattened()) {
            *place = *byte;
        }
        Some(Letter {
            kind: part.kind,
            node: part.from,
            bytes,
        })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{Assembly, LETTER_BYTES, Letter, LetterKind, PARTS, Part};
    use crate::{Frame, MAX_NODES, Message, NotAMessage};

    fn letters() -> impl Strategy<Value = Letter> {
        let kind = prop_oneof![Just(LetterKind::Packet), Just(LetterKind::Request)];
        let node = 0..MAX_NODES as u8;
        (kind, node, any::<[u8; LETTER_BYTES]>()).prop_map(|(kind, node, bytes)| Letter {
            kind,
            node,
            bytes,
        })
    }

    fn of_parts() -> impl Strategy<Value = Option<usize>> {
        prop::option::of(0..PARTS)
    }

    fn passed(assembly: &mut Assembly, frames: &[Frame]) -> Vec<Letter> {
        let parts = frames.iter().map(|frame| Part::of(frame).unwrap());
        parts.filter_map(|part| assembly.push(&part)).collect()
    }

    proptest! {
        /// Some are sent, a frame of each may be lost or come twice: whole ones come once, as they
        /// were, others not.
        #[test]
        fn a_letter_comes_whole_or_not_at_all(
            sent in prop::collection::vec((letters(), of_parts(), of_parts()), 1..9),
            from in 0..MAX_NODES as u8,
        ) {
            let mut assembly = Assembly::new();
            for (number, (letter, lost, twice)) in (0..).zip(sent) {
                let mut frames = letter.frames(from, number).to_vec();
                if let Some(twice) = twice.filter(|_| lost.is_none()) {
                    frames.insert(twice, frames[twice]);
                }
                if let Some(lost) = lost {
                    frames.remove(lost);
                }
                let whole = (lost.is_none()).then_some(Letter { node: from, ..letter });
                prop_assert_eq!(passed(&mut assembly, &frames), Vec::from_iter(whole));
            }
        }

        /// They go behind every message, and are none.
        #[test]
        fn letters_are_no_messages(letter in letters(), from in 0..MAX_NODES as u8) {
            let frames = letter.frames(from, 0);
            prop_assert!(frames.is_sorted_by(|a, b| a.id() < b.id()));
            let [id, mask] = Letter::REQUESTS;
            for frame in frames {
                prop_assert!(frame.id() > 15 << 5 | 31);
                prop_assert_eq!(Message::of(&frame), Err(NotAMessage));
                let is_request = letter.kind == LetterKind::Request;
                prop_assert_eq!(frame.id() & mask == id, is_request);
                prop_assert_eq!(Part::of(&frame).map(|part| part.to), Some(letter.node));
            }
        }
    }

    /// As the table above says, by hand.
    #[test]
    fn the_second_part_of_a_request_lies_where_the_page_says() {
        let letter = Letter {
            kind: LetterKind::Request,
            node: 5,
            bytes: core::array::from_fn(|n| n as u8),
        };
        let [_, second, _] = letter.frames(3, 2);
        assert_eq!(second.id(), 21 << 5 | 3);
        assert_eq!(second.bytes(), [2 << 5 | 5, 7, 8, 9, 10, 11, 12, 13]);
    }
}
