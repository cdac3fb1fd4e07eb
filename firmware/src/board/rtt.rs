//! RTT: rings in RAM that a probe reads and writes while the core runs.
//!
//! A control block, which the probe finds by its first bytes, lists the rings. Whoever writes
//! into one moves its writer's offset on once all is in it, whoever reads the reader's: neither
//! waits for the other. The layout is SEGGER's (UM08001, "RTT", the control block); probe-rs
//! reads the same.
//!
//! | ring | what |
//! |---|---|
//! | up 0 | the log, by defmt |
//! | up 1 | frames of packets, where the program has a link |
//! | down 0 | frames of requests, there too |

use core::sync::atomic::{AtomicU8, AtomicU32, Ordering, compiler_fence};

/// The log's ring: what idle writes within the 100 ms after which a probe comes by.
pub(crate) static LOG_BYTES: [AtomicU8; 1024] = [const { AtomicU8::new(0) }; 1024];

/// The ring of packets. At 2 kHz and one whisker 47 ms pass until records have filled it, four
/// times as long as a probe stays away; then some more wait in their queue.
#[cfg(feature = "rtt")]
pub(crate) static PACKETS: [AtomicU8; 1_920] = [const { AtomicU8::new(0) }; 1_920];

/// The ring of requests: some, as only one is carried out a tick.
#[cfg(feature = "rtt")]
pub(crate) static REQUESTS: [AtomicU8; 128] = [const { AtomicU8::new(0) }; 128];

#[repr(C)]
pub(crate) struct Ring {
    /// Ends with a zero.
    name: *const u8,
    start: *const u8,
    bytes: u32,
    /// Offsets, below `bytes`.
    writer: AtomicU32,
    reader: AtomicU32,
    /// What is done where there is no room. A probe may ask the writer to wait; none does.
    mode: AtomicU32,
}

#[allow(unsafe_code, reason = "it has pointers, which the probe follows")]
// SAFETY: they never change, and the program does not follow them; the rest is atomic.
unsafe impl Sync for Ring {}

/// What does not fit is left out.
const NON_BLOCKING_SKIP: u32 = 0;

impl Ring {
    pub(crate) const fn new<T, const N: usize>(
        name: &'static [u8],
        bytes: &'static [T; N],
    ) -> Self {
        Self {
            name: name.as_ptr(),
            start: bytes.as_ptr().cast(),
            bytes: size_of_val(bytes) as u32,
            writer: AtomicU32::new(0),
            reader: AtomicU32::new(0),
            mode: AtomicU32::new(NON_BLOCKING_SKIP),
        }
    }

    /// Where the writer stands; 0 where that is beyond the end, by a flipped bit.
    #[inline]
    pub(crate) fn writer(&self) -> u32 {
        let writer = self.writer.load(Ordering::Relaxed);
        if writer < self.bytes { writer } else { 0 }
    }

    #[inline]
    pub(crate) fn reader(&self) -> u32 {
        let reader = self.reader.load(Ordering::Relaxed);
        if reader < self.bytes { reader } else { 0 }
    }

    /// Bytes that fit in between a writer there and the reader. One stays free: offsets that
    /// are equal mean an empty ring.
    #[inline]
    pub(crate) fn room(&self, writer: u32) -> u32 {
        let ahead = self.reader().wrapping_sub(writer).wrapping_sub(1);
        if ahead < self.bytes {
            ahead
        } else {
            ahead.wrapping_add(self.bytes)
        }
    }

    #[inline]
    pub(crate) fn waiting(&self) -> u32 {
        let ahead = self.writer().wrapping_sub(self.reader());
        if ahead < self.bytes {
            ahead
        } else {
            ahead.wrapping_add(self.bytes)
        }
    }

    #[inline]
    pub(crate) fn has_written(&self, writer: u32) {
        // One core, and a probe that reads by the same bus: what is stored before is seen before.
        compiler_fence(Ordering::Release);
        self.writer.store(writer, Ordering::Relaxed);
    }

    #[inline]
    pub(crate) fn has_read(&self, reader: u32) {
        compiler_fence(Ordering::Release);
        self.reader.store(reader, Ordering::Relaxed);
    }
}

/// Puts bytes into a ring, whole or not at all, where so many more are kept free; whether it has.
#[cfg(feature = "rtt")]
pub(crate) fn put(ring: &Ring, places: &[AtomicU8], bytes: &[u8], kept: u32) -> bool {
    let mut at = ring.writer() as usize;
    if kept + bytes.len() as u32 > ring.room(at as u32) {
        return false;
    }
    for byte in bytes {
        if let Some(place) = places.get(at) {
            place.store(*byte, Ordering::Relaxed);
        }
        at = if at + 1 < places.len() { at + 1 } else { 0 };
    }
    ring.has_written(at as u32);
    true
}

#[cfg(feature = "rtt")]
const UPS: usize = 2;
#[cfg(feature = "rtt")]
const DOWNS: usize = 1;
#[cfg(not(feature = "rtt"))]
const UPS: usize = 1;
#[cfg(not(feature = "rtt"))]
const DOWNS: usize = 0;

#[repr(C)]
struct Block {
    id: [u8; 16],
    ups_count: u32,
    downs_count: u32,
    ups: [Ring; UPS],
    downs: [Ring; DOWNS],
}

/// Names are in RAM too: a probe reads them while it reads the block.
static LOG_NAME: [u8; 6] = *b"defmt\0";

#[allow(unsafe_code, reason = "a probe and other tools look for this name")]
// SAFETY: nothing else in the program has it.
#[unsafe(export_name = "_SEGGER_RTT")]
static BLOCK: Block = Block {
    id: *b"SEGGER RTT\0\0\0\0\0\0",
    ups_count: UPS as u32,
    downs_count: DOWNS as u32,
    ups: [
        Ring::new(&LOG_NAME, &LOG_BYTES),
        #[cfg(feature = "rtt")]
        Ring::new(b"whisker\0", &PACKETS),
    ],
    downs: [
        #[cfg(feature = "rtt")]
        Ring::new(b"whisker\0", &REQUESTS),
    ],
};

pub(crate) static LOG: &Ring = &BLOCK.ups[0];

#[cfg(feature = "rtt")]
pub(crate) static UP: &Ring = &BLOCK.ups[1];

#[cfg(feature = "rtt")]
pub(crate) static DOWN: &Ring = &BLOCK.downs[0];
