//! What the serial port is to send: a ring that the DMA empties.

use core::sync::atomic::AtomicU8;

use crate::board::counters::WrappingCounter;
use crate::board::rtt::{self, Ring};

/// Of the ring, so many bytes are kept for lines and answers where records take all they get.
const KEPT: u32 = 256;

/// Some lines, and records of as many ticks as idle may be late, which idle and the start put in.
/// Atomic, as the compiler does not see that the DMA reads them.
static BYTES: [AtomicU8; 1024] = [const { AtomicU8::new(0) }; 1024];
static RING: Ring = Ring::new(b"\0", &BYTES);

/// Lines and events that found no room, since the start.
pub(crate) static LOST: WrappingCounter = WrappingCounter::new();

pub(crate) fn line(bytes: &[u8]) {
    if !answer(bytes) {
        LOST.increment();
    }
}

/// Whether there was room.
pub(crate) fn answer(bytes: &[u8]) -> bool {
    rtt::put(&RING, &BYTES, bytes, 0)
}

/// Puts a record's frame in if room is left for lines; whether there was.
pub(crate) fn record(bytes: &[u8]) -> bool {
    rtt::put(&RING, &BYTES, bytes, KEPT)
}

/// The piece in one run that is to be sent: its address, and how many bytes.
pub(crate) fn piece() -> Option<(u32, u16)> {
    let (reader, writer) = (RING.reader(), RING.writer());
    let all = BYTES.len() as u32;
    let end = if writer < reader { all } else { writer };
    let first = BYTES.get(reader as usize).filter(|_| end > reader)?;
    // Pointers have 32 bits on these chips.
    Some((first.as_ptr() as u32, (end - reader) as u16))
}

pub(crate) fn has_sent(bytes: u16) {
    RING.has_read((RING.reader() + u32::from(bytes)) % BYTES.len() as u32);
}
