//! The sensor's side of the wire: replies for a slave or a simulator.

use crate::{FRAME_LEN, Status, crc};

/// A reply that carries a register.
pub const fn register(status: Status, value: u16) -> [u8; FRAME_LEN] {
    let [high, low] = value.to_be_bytes();
    let bits = status.bits();
    crc::sealed([(bits >> 4) as u8, high, low, (bits << 4) as u8])
}

/// A reply whose last bit is inverted: how the sensor says that the frame it answers came
/// with wrong check bits.
pub const fn rejecting(mut reply: [u8; FRAME_LEN]) -> [u8; FRAME_LEN] {
    reply[FRAME_LEN - 1] ^= 1;
    reply
}
