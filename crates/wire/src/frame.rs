//! What goes both ways as bytes: a value by [postcard], its CRC-32, and around both a frame by
//! COBS, without a zero in it and between two.
//!
//! [postcard]: https://postcard.jamesmunns.com/wire-format

use heapless::Vec;
use serde::{Deserialize, Serialize};

/// Most bytes of what a frame carries, the sum included: its first code stays below 32, by which
/// a [`Splitter`](crate::Splitter) knows a frame from text.
pub const CONTENT_BYTES: usize = 30;

/// What framing adds to them: a code, and a zero at either end.
const ADDED: usize = 3;

/// Most bytes of a frame.
pub const FRAME_BYTES: usize = CONTENT_BYTES + ADDED;

const SUM_BYTES: usize = size_of::<u32>();

/// Bytes of the frame of a record, which are always as many: 20, and one that says what it is.
pub const RECORD_FRAME_BYTES: usize = 1 + 20 + SUM_BYTES + ADDED;

/// A frame.
pub type Frame = Vec<u8, FRAME_BYTES>;

/// CRC-32 (ISO-HDLC), as in zip and in the model file, of `bytes` behind those whose sum is
/// `before`, 0 of none.
// A library of any CRC takes six times the flash, a hundredth of the smallest program.
pub fn crc32(before: u32, bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!before, |sum, byte| {
        (0..8).fold(sum ^ u32::from(*byte), |sum, _| {
            sum >> 1 ^ 0xEDB8_8320 & (sum & 1).wrapping_neg()
        })
    })
}

/// The frame of a value. One that does not fit has none, an empty one; packets and requests fit.
pub fn frame<T: Serialize>(value: &T) -> Frame {
    let mut room = [0; CONTENT_BYTES - SUM_BYTES];
    postcard::to_slice(value, &mut room).map_or(Frame::new(), |bytes| frame_of(bytes))
}

/// The same of a value's bytes.
pub fn frame_of(bytes: &[u8]) -> Frame {
    enclose(bytes).unwrap_or_default()
}

fn enclose(bytes: &[u8]) -> Option<Frame> {
    let mut content = Vec::<u8, CONTENT_BYTES>::new();
    content.extend_from_slice(bytes).ok()?;
    let sum = crc32(0, bytes).to_le_bytes();
    content.extend_from_slice(&sum).ok()?;
    let mut frame = Frame::new();
    frame.resize(FRAME_BYTES, 0).ok()?;
    let inner = frame.get_mut(1..FRAME_BYTES - 1)?;
    let coded = cobs::try_encode(&content, inner).ok()?;
    frame.truncate(1 + coded);
    frame.push(0).ok()?;
    Some(frame)
}

pub(crate) fn summed(content: &[u8]) -> Option<&[u8]> {
    let (value, sum) = content.split_last_chunk::<SUM_BYTES>()?;
    (crc32(0, value).to_le_bytes() == *sum).then_some(value)
}

/// The value that a frame carries: the bytes of a [`Piece::Frame`](crate::Piece::Frame). `None`
/// if its sum is not right, or it is no such value.
pub fn open<'c, T: Deserialize<'c>>(content: &'c [u8]) -> Option<T> {
    let (value, rest) = postcard::take_from_bytes(summed(content)?).ok()?;
    rest.is_empty().then_some(value)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{FRAME_BYTES, crc32, frame, open};
    use crate::{Piece, Splitter};

    fn content(frame: &[u8]) -> Vec<u8> {
        let mut splitter = Splitter::<FRAME_BYTES>::new();
        let pieces = frame.iter().filter_map(|byte| match splitter.push(*byte)? {
            Piece::Frame(content) => Some(content.to_vec()),
            piece => panic!("{piece:?}"),
        });
        pieces.last().expect("a frame")
    }

    #[test]
    fn the_sum_is_that_of_other_programs() {
        // python3 -c 'import zlib; print(hex(zlib.crc32(bytes([7, 5]))))'
        assert_eq!(crc32(crc32(0, &[7]), &[5]), 0x7EF2_70B7);
    }

    #[test]
    fn what_does_not_fit_has_no_frame() {
        assert!(frame(&[0x55_u8; 27]).is_empty());
        assert_eq!(frame(&[0x55_u8; 26]).len(), FRAME_BYTES);
    }

    proptest! {
        #[test]
        fn a_value_is_what_it_was_and_no_frame_has_a_zero_in_it(values: (u32, u16, [i32; 2])) {
            let framed = frame(&values);
            let inner = &framed[1..framed.len() - 1];
            prop_assert!(!inner.contains(&0) && inner[0] < 32);
            let content = content(&framed);
            prop_assert_eq!(open(&content), Some(values));
        }

        #[test]
        fn one_with_a_flipped_bit_is_none(value: (u16, u32), bit in 0..48_usize) {
            let mut content = content(&frame(&value));
            let at = bit / 8 % content.len();
            content[at] ^= 1 << (bit % 8);
            prop_assert_eq!(open::<(u16, u32)>(&content), None);
        }

        #[test]
        fn bytes_that_were_never_sent_are_none(bytes in prop::collection::vec(any::<u8>(), 0..5)) {
            prop_assert_eq!(open::<(u16, u32)>(&bytes), None);
        }
    }
}
