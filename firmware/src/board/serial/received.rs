//! What has come: a ring that the DMA fills, the tick looks at for a stop, and idle reads.

use core::sync::atomic::{AtomicU8, Ordering, compiler_fence};

use firmware::boards::RECEIVED_BYTES;

use crate::board::telemetry::Looked;

/// Atomic, as the compiler does not see that the DMA writes them.
static RING: [AtomicU8; RECEIVED_BYTES] = [const { AtomicU8::new(0) }; RECEIVED_BYTES];

static LOOKED: Looked = Looked::new();

pub(crate) fn ring() -> (&'static [AtomicU8], &'static Looked) {
    (&RING, &LOOKED)
}

/// Where the next byte will be, where so many are left until the DMA begins again.
#[inline]
pub(crate) fn writer(left: u16) -> usize {
    RECEIVED_BYTES.saturating_sub(left.into()) % RECEIVED_BYTES
}

pub(crate) fn address() -> u32 {
    // Pointers have 32 bits on these chips.
    RING.as_ptr() as u32
}

pub(crate) struct Received {
    at: usize,
}

impl Received {
    pub(crate) const fn new() -> Self {
        Self { at: 0 }
    }

    /// The next byte of those that the tick has looked at.
    pub(crate) fn next(&mut self) -> Option<u8> {
        if self.at == LOOKED.until(RECEIVED_BYTES) {
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

    pub(crate) fn count(&self) -> u32 {
        LOOKED.bytes_until(self.at, RECEIVED_BYTES)
    }
}
