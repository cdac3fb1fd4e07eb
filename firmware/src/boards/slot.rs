//! What stands before a configuration in flash: which of two is the newer, which model it was
//! deployed with, and whether it has armed motors by itself.

/// Words of a [`SlotHeader`].
pub const SLOT_HEADER_WORDS: usize = 4;

/// Words of the [mark](has_armed) behind it: a pair, by which the flash of some boards is written.
pub const MARK_WORDS: usize = 2;

/// Bytes of both; the configuration begins behind them.
pub const SLOT_HEADER_BYTES: usize = (SLOT_HEADER_WORDS + MARK_WORDS) * size_of::<u32>();

const MAGIC: u32 = u32::from_le_bytes(*b"WSLT");

/// It is written between the model, whose sum it holds, and the configuration, whose first two
/// words come last: without them a slot counts as none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SlotHeader {
    /// Counts deployments; wraps around.
    pub sequence: u32,
    /// The CRC-32 at the end of the model that it was deployed with; 0: none.
    pub model: u32,
}

impl SlotHeader {
    /// Of what a program brings with it.
    pub const fn linked(model: u32) -> Self {
        Self { sequence: 1, model }
    }

    /// As it lies in flash: magic, sequence, CRC of the model, CRC-32 of the three.
    pub fn words(self) -> [u32; SLOT_HEADER_WORDS] {
        let Self { sequence, model } = self;
        [MAGIC, sequence, model, sum([MAGIC, sequence, model])]
    }

    /// The same byte by byte, little-endian, and a mark that is not set.
    pub fn bytes(self) -> [u8; SLOT_HEADER_BYTES] {
        let mut bytes = [u8::MAX; SLOT_HEADER_BYTES];
        let (places, _) = bytes.as_chunks_mut::<4>();
        for (place, word) in places.iter_mut().zip(self.words()) {
            *place = word.to_le_bytes();
        }
        bytes
    }

    /// That at the start of `bytes`; `None` where there is none, or a damaged one.
    pub fn of(bytes: &[u8]) -> Option<Self> {
        let (words, _) = bytes.as_chunks::<4>();
        let &[magic, sequence, model, found, ..] = words else {
            return None;
        };
        let [magic, sequence, model] = [magic, sequence, model].map(u32::from_le_bytes);
        let is_whole = magic == MAGIC && u32::from_le_bytes(found) == sum([magic, sequence, model]);
        is_whole.then_some(Self { sequence, model })
    }
}

/// Whether the scene of the slot that begins with `bytes` has armed motors by itself, which it does
/// once: a mark in flash, of zeros, which can be written over what a linker left erased too, says
/// so. It outlives a loss of power, and is gone with the next deployment.
pub fn has_armed(bytes: &[u8]) -> bool {
    let (words, _) = bytes.as_chunks::<4>();
    let mut mark = words.iter().skip(SLOT_HEADER_WORDS).take(MARK_WORDS);
    mark.any(|word| *word != [u8::MAX; 4])
}

fn sum(words: [u32; 3]) -> u32 {
    wire::crc32(0, words.map(u32::to_le_bytes).as_flattened())
}

/// Newest first, as a start looks at them. One whose header is none comes last.
pub fn newest_first(headers: [Option<SlotHeader>; 2]) -> [usize; 2] {
    // Across the wrap, too.
    let is_after = |one: u32, other: u32| one.wrapping_sub(other).cast_signed() > 0;
    match headers {
        [Some(first), Some(second)] if is_after(second.sequence, first.sequence) => [1, 0],
        [None, Some(_)] => [1, 0],
        _ => [0, 1],
    }
}

/// Which slot the next deployment is written into, and by which sequence, where a module runs by
/// the scene of the slot `in_use`, or by none: never that one, and newer than both.
pub fn next(headers: [Option<SlotHeader>; 2], in_use: Option<usize>) -> (usize, u32) {
    let [newest, oldest] = newest_first(headers);
    let slot = match in_use {
        Some(0) => 1,
        Some(_) => 0,
        None => oldest,
    };
    let newest = headers.get(newest).copied().flatten();
    let sequence = newest.map_or(1, |newest| newest.sequence.wrapping_add(1));
    (slot, sequence)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{SLOT_HEADER_WORDS, SlotHeader, has_armed, newest_first, next};

    const fn header(sequence: u32) -> SlotHeader {
        SlotHeader { sequence, model: 7 }
    }

    proptest! {
        #[test]
        fn a_header_is_read_as_it_was_written_and_none_with_a_flipped_bit(
            (sequence, model) in any::<(u32, u32)>(),
            bit in 0..32 * SLOT_HEADER_WORDS,
        ) {
            let header = SlotHeader { sequence, model };
            let mut bytes = header.bytes();
            prop_assert_eq!(SlotHeader::of(&bytes), Some(header));
            bytes[bit / 8] ^= 1 << (bit % 8);
            prop_assert_eq!(SlotHeader::of(&bytes), None);
        }
    }

    #[test]
    fn a_mark_is_any_bit_that_is_written() {
        let bytes = header(1).bytes();
        assert!(!has_armed(&bytes));
        for bit in 32 * SLOT_HEADER_WORDS..8 * bytes.len() {
            let mut marked = bytes;
            marked[bit / 8] ^= 1 << (bit % 8);
            assert!(has_armed(&marked), "bit {bit}");
            assert_eq!(SlotHeader::of(&marked), Some(header(1)));
        }
    }

    #[test]
    fn the_newer_of_two_comes_first_across_the_wrap() {
        for (sequences, order) in [
            ([Some(1), Some(2)], [1, 0]),
            ([Some(2), Some(1)], [0, 1]),
            ([Some(u32::MAX), Some(0)], [1, 0]),
            ([Some(0), Some(u32::MAX)], [0, 1]),
            ([None, Some(5)], [1, 0]),
            ([Some(5), None], [0, 1]),
            ([None, None], [0, 1]),
        ] {
            let headers = sequences.map(|sequence| sequence.map(header));
            assert_eq!(newest_first(headers), order, "{headers:?}");
        }
        // Flash that was never written has none.
        for bytes in [&[0; 16][..], &[0xFF; 16], &[]] {
            assert_eq!(SlotHeader::of(bytes), None);
        }
    }

    #[test]
    fn the_slot_in_use_is_never_written_and_the_written_one_is_the_newest() {
        for sequences in [
            [None, None],
            [Some(1), None],
            [None, Some(1)],
            [Some(8), Some(9)],
            [Some(9), Some(8)],
            [Some(u32::MAX), Some(0)],
        ] {
            let headers = sequences.map(|sequence| sequence.map(header));
            for in_use in [None, Some(0), Some(1)] {
                let (slot, sequence) = next(headers, in_use);
                assert_ne!(Some(slot), in_use);
                let mut after = headers;
                after[slot] = Some(header(sequence));
                assert_eq!(newest_first(after)[0], slot, "{headers:?}, {in_use:?}");
            }
        }
        assert_eq!(next([Some(header(1)), None], Some(0)), (1, 2));
        assert_eq!(next([None, None], None), (1, 1));
    }
}
