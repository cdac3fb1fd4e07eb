//! Brings lines of defmt into the log's ring, whole or not at all.
//!
//! A line is written behind the writer's offset and becomes part of the ring when it is
//! whole, so the tick may come in between. Only idle and what comes before it write lines,
//! and fault handlers, which never return: a line that one of those interrupts is never
//! finished, and theirs takes its place.

use core::cell::UnsafeCell;
use core::sync::atomic::Ordering;

use defmt::{Encoder, global_logger};

use super::rtt::{LOG, LOG_BYTES};

struct Line {
    encoder: Encoder,
    staged: Staged,
    is_open: bool,
}

/// The bytes of a line behind the writer's offset.
struct Staged {
    at: usize,
    room: u32,
    is_lost: bool,
}

impl Staged {
    fn put(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            let place = LOG_BYTES.get(self.at).filter(|_| self.room > 0);
            let Some(place) = place else {
                self.is_lost = true;
                return;
            };
            place.store(byte, Ordering::Relaxed);
            self.room -= 1;
            self.at = if self.at + 1 < LOG_BYTES.len() {
                self.at + 1
            } else {
                0
            };
        }
    }
}

struct Shared(UnsafeCell<Line>);

#[allow(unsafe_code, reason = "idle and fault handlers share it")]
// SAFETY: one core, and whoever interrupts a line to write another never returns to it.
unsafe impl Sync for Shared {}

static LINE: Shared = Shared(UnsafeCell::new(Line {
    encoder: Encoder::new(),
    staged: Staged {
        at: 0,
        room: 0,
        is_lost: false,
    },
    is_open: false,
}));

impl Shared {
    fn with(&self, work: impl FnOnce(&mut Line)) {
        #[allow(unsafe_code, reason = "the state of a logger, which can have none")]
        // SAFETY: see `Shared`; `work` writes no other line.
        work(unsafe { &mut *self.0.get() });
    }
}

#[global_logger]
struct Logger;

#[allow(unsafe_code, reason = "defmt asks for it")]
// SAFETY: lines do not interleave: see `Shared`.
unsafe impl defmt::Logger for Logger {
    fn acquire() {
        LINE.with(|line| {
            if line.is_open {
                line.encoder = Encoder::new();
            }
            line.is_open = true;
            let writer = LOG.writer();
            line.staged = Staged {
                at: writer as usize,
                room: LOG.room(writer),
                is_lost: false,
            };
            line.encoder.start_frame(|bytes| line.staged.put(bytes));
        });
    }

    unsafe fn flush() {}

    unsafe fn release() {
        LINE.with(|line| {
            line.encoder.end_frame(|bytes| line.staged.put(bytes));
            line.is_open = false;
            if !line.staged.is_lost {
                LOG.has_written(line.staged.at as u32);
            }
        });
    }

    unsafe fn write(bytes: &[u8]) {
        LINE.with(|line| line.encoder.write(bytes, |bytes| line.staged.put(bytes)));
    }
}
