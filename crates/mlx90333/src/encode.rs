//! The sensor's side of the wire: frames for a slave or a simulator.
//!
//! With [`SumRule::Ignore`], which says nothing of B7, the default rule's sum
//! is sent. Decoding with the same mode and rule gives back what was encoded.

use crate::{Decoder, FRAME_LEN, Faults, START_BYTE, SumRule, Word};

/// An alpha-beta frame. With `faults` other than [`Faults::NONE`] it decodes to
/// [`FrameError::Sensor`](crate::FrameError::Sensor).
pub const fn alpha_beta(
    alpha: Word,
    beta: Word,
    faults: Faults,
    sum_rule: SumRule,
) -> [u8; FRAME_LEN] {
    frame([alpha.raw(), beta.raw(), faults.bits()], sum_rule)
}

/// The frame of three words, as whoever decodes by `decoder` takes it; the last is the error word
/// in alpha-beta mode.
pub const fn words(words: [u16; 3], decoder: Decoder) -> [u8; FRAME_LEN] {
    let Decoder {
        sum_rule,
        byte_order,
        ..
    } = decoder;
    // In the other order they are other numbers.
    let [first, second, third] = words;
    let swapped = [
        u16::from_le_bytes(byte_order.bytes(first)),
        u16::from_le_bytes(byte_order.bytes(second)),
        u16::from_le_bytes(byte_order.bytes(third)),
    ];
    frame(swapped, sum_rule)
}

const fn frame(words: [u16; 3], sum_rule: SumRule) -> [u8; FRAME_LEN] {
    let [first, second, third] = words;
    let [b1, b2] = first.to_le_bytes();
    let [b3, b4] = second.to_le_bytes();
    let [b5, b6] = third.to_le_bytes();
    let mut bytes = [START_BYTE, b1, b2, b3, b4, b5, b6, 0];
    let sum = match sum_rule.expected(&bytes) {
        Some(sum) => Some(sum),
        None => SumRule::SumB1B6.expected(&bytes),
    };
    if let Some(sum) = sum {
        bytes[FRAME_LEN - 1] = sum;
    }
    bytes
}
