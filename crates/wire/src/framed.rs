//! Packets and requests on a serial line: between zeros, without zeros in them (COBS).

use crate::request::{REQUEST_BYTES, TaggedCommand};
use crate::words::{PACKET_BYTES, PACKET_WORDS};

/// What framing adds to fewer than 254 bytes: a code, and a zero at either end.
const ADDED: usize = 3;

/// Bytes of a packet's frame.
pub const PACKET_FRAME_BYTES: usize = PACKET_BYTES + ADDED;

/// Bytes of a request's frame.
pub const REQUEST_FRAME_BYTES: usize = REQUEST_BYTES + ADDED;

/// Some bytes as `N` of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Framed<const N: usize>([u8; N]);

impl Framed<PACKET_FRAME_BYTES> {
    /// The frame of a packet.
    pub fn packet(words: [u32; PACKET_WORDS]) -> Self {
        let words = words.map(u32::to_le_bytes);
        Self::of(words.as_flattened())
    }
}

impl Framed<REQUEST_FRAME_BYTES> {
    /// The frame of a request.
    pub fn request(request: &TaggedCommand) -> Self {
        Self::of(&request.bytes())
    }
}

impl<const N: usize> Framed<N> {
    /// The frame of `N` − 3 bytes.
    fn of(bytes: &[u8]) -> Self {
        let mut frame = [0; N];
        // It fits: fewer than 254 bytes get one code. The zeros at both ends are there.
        if let Some(inner) = frame.get_mut(1..) {
            let _ = cobs::try_encode(bytes, inner);
        }
        Self(frame)
    }

    /// As it is sent.
    pub const fn bytes(&self) -> &[u8; N] {
        &self.0
    }
}
