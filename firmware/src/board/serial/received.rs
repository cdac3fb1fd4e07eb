//! What the serial port has received: a ring that the DMA fills, and idle reads.

use core::sync::atomic::{AtomicU8, Ordering, compiler_fence};

use firmware::boards::RECEIVED_BYTES;

/// Atomic, as the compiler does not see that the DMA writes them.
static RING: [AtomicU8; RECEIVED_BYTES] = [const { AtomicU8::new(0) }; RECEIVED_BYTES];

/// Where the ring is.
pub(crate) fn address() -> u32 {
    // Pointers have 32 bits on these chips.
    RING.as_ptr() as u32
}

/// The reader of the ring.
pub(crate) struct Received {
    /// The next byte.
    at: usize,
}

impl Received {
    /// Before the first byte.
    pub(crate) const fn new() -> Self {
        Self { at: 0 }
    }

    /// The next byte, where so many are left until the DMA begins again.
    pub(crate) fn next(&mut self, left: u16) -> Option<u8> {
        let writer = RECEIVED_BYTES.saturating_sub(left.into()) % RECEIVED_BYTES;
        if self.at == writer {
            return None;
        }
        compiler_fence(Ordering::Acquire);
        // A flipped bit has it begin again.
        let byte = RING
            .get(self.at)
            .map_or(0, |byte| byte.load(Ordering::Relaxed));
        self.at = (self.at + 1) % RECEIVED_BYTES;
        Some(byte)
    }
}
