//! What the serial port is to send: a ring that the DMA empties.

use core::sync::atomic::{AtomicU8, AtomicU32, Ordering};

use crate::board::counters::WrappingCounter;

/// Bytes of the ring: some lines, and the records of as many ticks as idle may be late.
const BYTES: usize = 1024;

/// Of those, so many are kept for lines and answers where records take all they get.
const KEPT: usize = 256;

/// Atomic, as the compiler does not see that the DMA reads them.
static RING: [AtomicU8; BYTES] = [const { AtomicU8::new(0) }; BYTES];

/// Where the next byte is put, and the first that is not sent. Only idle, and the start
/// before it, change them.
static WRITER: AtomicU32 = AtomicU32::new(0);
static READER: AtomicU32 = AtomicU32::new(0);

/// Lines and events that found no room, since the start.
pub(crate) static LOST: WrappingCounter = WrappingCounter::new();

/// An offset; 0 where that is beyond the end, by a flipped bit.
fn offset(of: &AtomicU32) -> usize {
    let found = of.load(Ordering::Relaxed) as usize;
    if found < BYTES { found } else { 0 }
}

/// Bytes that fit. One stays free: offsets that are equal mean an empty ring.
fn room() -> usize {
    (offset(&READER) + BYTES - offset(&WRITER) - 1) % BYTES
}

/// Puts bytes in, whole or not at all; whether it has.
fn put(bytes: &[u8]) -> bool {
    if bytes.len() > room() {
        return false;
    }
    let mut at = offset(&WRITER);
    for &byte in bytes {
        if let Some(place) = RING.get(at) {
            place.store(byte, Ordering::Relaxed);
        }
        at = (at + 1) % BYTES;
    }
    WRITER.store(at as u32, Ordering::Relaxed);
    true
}

pub(crate) fn line(bytes: &[u8]) {
    if !put(bytes) {
        LOST.increment();
    }
}

/// Whether there was room.
pub(crate) fn answer(bytes: &[u8]) -> bool {
    put(bytes)
}

/// Puts a record's frame in if room is left for lines; whether there was.
pub(crate) fn record(bytes: &[u8]) -> bool {
    room() >= KEPT + bytes.len() && put(bytes)
}

/// The piece in one run that is to be sent: its address, and how many bytes.
pub(crate) fn piece() -> Option<(u32, u16)> {
    let (reader, writer) = (offset(&READER), offset(&WRITER));
    let end = if writer < reader { BYTES } else { writer };
    let first = RING.get(reader).filter(|_| end > reader)?;
    // Pointers have 32 bits on these chips.
    Some((first.as_ptr() as u32, (end - reader) as u16))
}

pub(crate) fn has_sent(bytes: u16) {
    let reader = (offset(&READER) + usize::from(bytes)) % BYTES;
    READER.store(reader as u32, Ordering::Relaxed);
}
