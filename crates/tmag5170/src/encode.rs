//! The sensor's side of the wire: replies for a slave or a simulator.

use crate::{FRAME_LEN, Status, crc};

/// A reply that carries a register.
pub const fn register(status: Status, value: u16) -> [u8; FRAME_LEN] {
    let [high, low] = value.to_be_bytes();
    let bits = status.bits();
    crc::sealed([(bits >> 4) as u8, high, low, (bits << 4) as u8])
}

/// A reply that carries two channels, the lower twelve bits of each, and the lowest four
/// status bits.
pub const fn pair(status: Status, first: u16, second: u16) -> [u8; FRAME_LEN] {
    let status = (status.bits() << 4) as u8;
    let [first, second] = [first & 0x0FFF, second & 0x0FFF];
    crc::sealed([
        status | (second >> 8) as u8,
        (second & 0x00F0) as u8 | (first >> 8) as u8,
        (first & 0x00F0) as u8 | (second & 0x000F) as u8,
        (first << 4) as u8,
    ])
}

/// A reply whose last bit is inverted: how the sensor says that the frame it answers came
/// with wrong check bits.
pub const fn rejecting(mut reply: [u8; FRAME_LEN]) -> [u8; FRAME_LEN] {
    reply[FRAME_LEN - 1] ^= 1;
    reply
}
