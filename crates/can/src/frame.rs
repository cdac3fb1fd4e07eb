//! A data frame of CAN 2.0 with a standard identifier.

/// A data frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frame {
    id: u16,
    length: u8,
    data: [u8; 8],
}

/// Most bits of a frame with the three between it and the next: eight bytes, stuffed throughout.
pub const MOST_BITS: u32 = 135;

/// Bits from the start of a frame to the end of its sum, without its data.
const HEAD_AND_SUM_BITS: usize = 34;

/// Bits behind the sum: its delimiter, acknowledgement with delimiter, end, and the space to the
/// next frame. They are not stuffed.
const TAIL_BITS: u32 = 1 + 2 + 7 + 3;

/// x^15 + x^14 + x^10 + x^8 + x^7 + x^4 + x^3 + 1, without its first term.
const POLYNOMIAL: u16 = 0x4599;

impl Frame {
    /// The frame of an identifier of eleven bits and up to eight bytes; what is more is cut off.
    pub fn new(id: u16, bytes: &[u8]) -> Self {
        let mut data = [0; 8];
        let mut length = 0;
        for (place, byte) in data.iter_mut().zip(bytes) {
            *place = *byte;
            length += 1;
        }
        Self {
            id: id & 0x7ff,
            length,
            data,
        }
    }

    /// Its identifier; of two that begin together the lower goes first.
    pub const fn id(&self) -> u16 {
        self.id
    }

    /// Its data.
    pub fn bytes(&self) -> &[u8] {
        self.data.get(..self.length.into()).unwrap_or_default()
    }

    /// Bits from its start to the end of its data: start, identifier, three that are dominant,
    /// length, data.
    fn content(&self) -> impl Iterator<Item = bool> + '_ {
        let head = u32::from(self.id) << 7 | u32::from(self.length);
        let head = (0..19).rev().map(move |n| head >> n & 1 == 1);
        let bits = |byte: &u8| {
            let byte = *byte;
            (0..8).rev().map(move |n| byte >> n & 1 == 1)
        };
        head.chain(self.bytes().iter().flat_map(bits))
    }

    /// CRC-15 of CAN.
    fn sum(&self) -> u16 {
        self.content().fold(0, |sum, bit| {
            let is_out = (sum >> 14 & 1 == 1) != bit;
            let shifted = sum << 1 & 0x7fff;
            if is_out {
                shifted ^ POLYNOMIAL
            } else {
                shifted
            }
        })
    }

    /// How long it keeps the bus busy, bits, with those that are stuffed (one after five that are
    /// alike) and with the three between it and the next; at most [`MOST_BITS`].
    pub fn bits(&self) -> u32 {
        let sum = self.sum();
        let sum = (0..15).rev().map(move |n| sum >> n & 1 == 1);
        let (mut last, mut alike, mut stuffed) = (true, 0, 0);
        for bit in self.content().chain(sum) {
            alike = if bit == last { alike + 1 } else { 1 };
            last = bit;
            if alike == 5 {
                stuffed += 1;
                (last, alike) = (!bit, 1);
            }
        }
        let plain = HEAD_AND_SUM_BITS + 8 * usize::from(self.length);
        plain as u32 + stuffed + TAIL_BITS
    }
}

#[cfg(test)]
mod tests {
    use super::{Frame, MOST_BITS};
    use proptest::prelude::*;

    /// A library's sum, and its check value (the catalogue of parametrised CRC algorithms).
    #[test]
    fn the_sum_is_that_of_the_standard() {
        let standard = crc::Crc::<u16>::new(&crc::CRC_15_CAN);
        assert_eq!(standard.checksum(b"123456789"), 0x059e);
        // Five zero bits before the nineteen of the head make whole bytes, and change no sum.
        let frame = Frame::new(0x123, &[1, 0xff, 0, 0x55]);
        let bytes = [0, 0x91, 0x84, 1, 0xff, 0, 0x55];
        let head = 0x123_u32 << 7 | 4;
        assert_eq!(bytes[..3], head.to_be_bytes()[1..]);
        assert_eq!(frame.sum(), standard.checksum(&bytes));
    }

    /// The shortest and longest that a standard frame of 0 and 8 bytes can be: 44 + 8 n bits
    /// unstuffed, at most (34 + 8 n − 1)/4 more, and three between two.
    #[test]
    fn frames_are_as_long_as_the_standard_says() {
        let worst = |bytes: u32| 47 + 8 * bytes + (33 + 8 * bytes) / 4;
        assert_eq!(worst(8), MOST_BITS);
        // An identifier of alternating bits, and data that are stuffed nowhere.
        let plain = Frame::new(0x2aa, &[0x55; 8]);
        assert!((111..=115).contains(&plain.bits()), "{}", plain.bits());
        assert!(Frame::new(0, &[0; 8]).bits() > 120);
    }

    proptest! {
        #[test]
        fn a_frame_is_never_longer_than_the_worst(
            id in 0_u16..0x800,
            data in proptest::collection::vec(any::<u8>(), 0..=8),
        ) {
            let frame = Frame::new(id, &data);
            let plain = 47 + 8 * data.len() as u32;
            let most = plain + (33 + 8 * data.len() as u32) / 4;
            prop_assert!((plain..=most).contains(&frame.bits()));
            prop_assert_eq!(frame.bytes(), &data[..]);
        }
    }
}
