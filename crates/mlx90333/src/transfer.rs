//! Reading a frame one byte per interrupt, without waiting for the bus.
//!
//! A frame takes a good part of a millisecond (see [`crate::timing`]), too long
//! to wait for inside a control tick. The interrupt handler owns the SPI
//! peripheral and a [`Transfer`]; the tick uses the last frame completed.

use crate::{FRAME_LEN, MASTER_BYTE};

/// What to do after a byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub enum Step {
    /// Send this byte, after the gap the sensor needs between bytes.
    Send(u8),
    /// Raise /SS: these are the eight bytes, not yet decoded.
    Done([u8; FRAME_LEN]),
    /// Nothing: no frame is under way and the byte was dropped.
    Idle,
}

/// The bytes of one frame as they arrive.
///
/// ```
/// use mlx90333::{Decoder, FrameError, Step, Transfer};
///
/// let mut transfer = Transfer::new();
/// // Lower /SS, then:
/// let mut send = transfer.start();
/// let bytes = loop {
///     assert_eq!(send, 0xFF);
///     let received = 0xFF; // from the data register; here no sensor answers
///     match transfer.on_byte(received) {
///         Step::Send(next) => send = next,
///         Step::Done(bytes) => break bytes,
///         Step::Idle => unreachable!(),
///     }
/// };
/// // Raise /SS, then:
/// assert_eq!(Decoder::new().decode(&bytes), Err(FrameError::NoSensor));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Transfer {
    bytes: [u8; FRAME_LEN],
    /// Bytes received so far; `FRAME_LEN` when no frame is under way.
    received: usize,
}

impl Transfer {
    /// No frame under way.
    pub const fn new() -> Transfer {
        Transfer {
            bytes: [0; FRAME_LEN],
            received: FRAME_LEN,
        }
    }

    /// Begins a frame and returns the first byte to send. A frame under way is
    /// dropped; its /SS must have been raised.
    pub const fn start(&mut self) -> u8 {
        self.received = 0;
        MASTER_BYTE
    }

    /// Takes the byte received and says what is next.
    pub fn on_byte(&mut self, received: u8) -> Step {
        let Some(slot) = self.bytes.get_mut(self.received) else {
            return Step::Idle;
        };
        *slot = received;
        self.received += 1;
        if self.received < FRAME_LEN {
            Step::Send(MASTER_BYTE)
        } else {
            Step::Done(self.bytes)
        }
    }

    /// Gives up the frame under way, if any: on a bus error or a timeout. The caller raises /SS.
    pub const fn abort(&mut self) {
        self.received = FRAME_LEN;
    }

    /// Whether a frame is under way.
    pub const fn is_busy(&self) -> bool {
        self.received < FRAME_LEN
    }
}

impl Default for Transfer {
    fn default() -> Transfer {
        Transfer::new()
    }
}
