//! The two rings of a probe: frames of packets go up, those of requests come down.

use core::sync::atomic::Ordering;

use wire::{Answer, COMMAND_BYTES, Frame, Piece, Request, Splitter};

use super::stops::PROBE;
use crate::board::rtt::{self, DOWN, PACKETS, REQUESTS, UP};

/// Bytes of the ring that records leave free, for events and answers.
const KEPT: u32 = 128;

pub(crate) struct ProbeLine {
    /// That of the serial line, lest its code be there twice.
    splitter: Splitter<COMMAND_BYTES>,
}

impl ProbeLine {
    pub(crate) const fn new() -> Self {
        Self {
            splitter: Splitter::new(),
        }
    }

    /// For a loader: no tick looks for stops any more.
    pub(crate) fn next(&mut self) -> Option<Request> {
        PROBE.is_at(DOWN.writer() as usize, REQUESTS.len());
        self.next_looked_at()
    }

    pub(crate) fn is_waiting(&self) -> bool {
        DOWN.reader() as usize != PROBE.until(REQUESTS.len())
    }

    pub(crate) fn count(&self) -> u32 {
        PROBE.bytes_until(DOWN.reader() as usize, REQUESTS.len())
    }

    pub(crate) fn next_looked_at(&mut self) -> Option<Request> {
        while self.is_waiting() {
            let at = DOWN.reader() as usize;
            // Erased, lest a flipped bit in an offset has a request carried out again.
            let byte = REQUESTS.get(at).map_or(0, |place| {
                let byte = place.load(Ordering::Relaxed);
                place.store(0, Ordering::Relaxed);
                byte
            });
            DOWN.has_read(if at + 1 < REQUESTS.len() {
                at as u32 + 1
            } else {
                0
            });
            if let Some(Piece::Frame(content)) = self.splitter.push(byte)
                && let Some(asked) = Request::read(content)
            {
                return Some(asked);
            }
        }
        None
    }

    /// Puts a record's frame in if room is left for the others; whether there was.
    pub(crate) fn record(frame: &Frame) -> bool {
        rtt::put(UP, &PACKETS, frame, KEPT)
    }

    pub(crate) fn put(frame: &Frame) -> bool {
        rtt::put(UP, &PACKETS, frame, 0)
    }

    /// Sends an answer of a loader, which waits for nothing.
    pub(crate) fn reply(answer: &Answer) {
        Self::put(&wire::frame_of(&firmware::Packet::Answer(*answer).bytes()));
    }

    pub(crate) fn has_sent() -> bool {
        UP.waiting() == 0
    }
}
