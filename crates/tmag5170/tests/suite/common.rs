//! What the tests by topic share: the CRC once more, and a bus that expects frames.

use embedded_hal_mock::eh1::spi::{Mock, Transaction};
use tmag5170::Tmag5170;

/// The check bits as the data sheet's own code computes them, bit by bit: a shift register
/// over the 28 bits and four zeros.
pub(crate) fn crc_by_shifting(frame: [u8; 4]) -> u8 {
    let padded = u32::from_be_bytes(frame) & 0xFFFF_FFF0;
    let mut crc = [true; 4];
    for i in (0..32).rev() {
        let inv = ((padded >> i) & 1 == 1) ^ crc[3];
        crc = [inv, crc[0] ^ inv, crc[1], crc[2]];
    }
    crc.iter()
        .rev()
        .fold(0, |bits, &bit| (bits << 1) | u8::from(bit))
}

/// The 28 bits of a frame with their check bits.
pub(crate) fn sealed(bits: u32) -> [u8; 4] {
    let [b0, b1, b2, b3] = (bits << 4).to_be_bytes();
    [b0, b1, b2, b3 | crc_by_shifting([b0, b1, b2, b3])]
}

pub(crate) fn frame(sent: u32, answered: [u8; 4]) -> [Transaction<u8>; 3] {
    [
        Transaction::transaction_start(),
        Transaction::transfer_in_place(sealed(sent).to_vec(), answered.to_vec()),
        Transaction::transaction_end(),
    ]
}

pub(crate) fn sensor(frames: &[[Transaction<u8>; 3]]) -> Tmag5170<Mock<u8>> {
    Tmag5170::new(Mock::new(&frames.concat()))
}
