//! What the tick does about the bytes that have come: it looks for a stop among them before
//! anything else is done with them.
//!
//! Idle reads a link as far as the tick has looked at it. So a stop takes effect in the tick after
//! its last byte, whatever waits before it; and it has a place among what comes, by which an
//! arming that was asked for before it is known.

use core::sync::atomic::{AtomicU8, AtomicU32, Ordering, compiler_fence};

use wire::{Stop, StopWatch};

use crate::board::rtt::{DOWN, REQUESTS};
#[cfg(feature = "serial")]
use crate::board::serial;

/// Bytes of a link that the tick has looked at, since the start.
pub(crate) struct Looked(AtomicU32);

impl Looked {
    pub(crate) const fn new() -> Self {
        Self(AtomicU32::new(0))
    }

    #[inline]
    pub(crate) fn bytes(&self) -> u32 {
        self.0.load(Ordering::Relaxed)
    }

    /// The place in a ring of so many bytes, a power of two (a remainder would have a panic for a
    /// ring of none), up to which it has looked.
    #[inline]
    pub(crate) fn until(&self, ring: usize) -> usize {
        self.bytes() as usize & ring.wrapping_sub(1)
    }

    /// How many had come with the byte before `at`, to which idle has read the ring.
    pub(crate) fn bytes_until(&self, at: usize, ring: usize) -> u32 {
        let bytes = self.bytes();
        let ahead = (bytes as usize).wrapping_sub(at) & ring.wrapping_sub(1);
        bytes.wrapping_sub(ahead as u32)
    }

    /// It has looked at all of a ring before its writer.
    pub(crate) fn is_at(&self, writer: usize, ring: usize) {
        let bytes = self.bytes();
        let more = writer.wrapping_sub(bytes as usize) & ring.wrapping_sub(1);
        self.0
            .store(bytes.wrapping_add(more as u32), Ordering::Relaxed);
    }
}

pub(crate) static PROBE: Looked = Looked::new();

/// Stops that idle is to answer: their count in the high half, the last one's tag in the other.
/// In one word, as the tick may write it while idle reads it.
pub(crate) struct Owed(AtomicU32);

impl Owed {
    const fn new() -> Self {
        Self(AtomicU32::new(0))
    }

    fn add(&self, tag: u16) {
        let count = (self.get() >> 16).wrapping_add(1) << 16;
        self.0.store(count | u32::from(tag), Ordering::Relaxed);
    }

    /// What it says now: it differs from what it said before if something is owed.
    pub(crate) fn get(&self) -> u32 {
        self.0.load(Ordering::Relaxed)
    }
}

/// To a probe, as a frame and as a line of the serial port.
pub(crate) static OWED: [Owed; 3] = [const { Owed::new() }; 3];

/// The tick in which the last stop took effect.
pub(crate) static STOPPED_IN: AtomicU32 = AtomicU32::new(0);

/// Bytes behind which a stop is followed.
const FAR: u32 = 1 << 20;

#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum By {
    Probe,
    Serial,
}

pub(crate) struct Stops {
    probe: Option<StopWatch>,
    #[cfg(feature = "serial")]
    serial: Option<StopWatch>,
    /// What had come by each when the last stop was seen: the probe, the serial port.
    stopped_at: [u32; 2],
}

impl Stops {
    pub(crate) fn new(links: firmware::Links) -> Self {
        Self {
            probe: links.has_rtt.then(StopWatch::new),
            #[cfg(feature = "serial")]
            serial: links.serial_baud.map(|_| StopWatch::new()),
            stopped_at: [0; 2],
        }
    }

    /// Whether there is a stop in what has come since the last tick.
    #[inline]
    pub(crate) fn look(&mut self, tick: u32) -> bool {
        self.has_more() && self.look_at_links(tick)
    }

    #[inline]
    fn has_more(&self) -> bool {
        #[cfg(feature = "serial")]
        if self.serial.is_some() {
            let (ring, looked) = serial::ring();
            if serial::writer() != looked.until(ring.len()) {
                return true;
            }
        }
        self.probe.is_some() && DOWN.writer() as usize != PROBE.until(REQUESTS.len())
    }

    // Apart, so that a tick in which nothing has come keeps its registers.
    #[cold]
    #[inline(never)]
    fn look_at_links(&mut self, tick: u32) -> bool {
        let mut stops = [None; 2];
        if let Some(watch) = &mut self.probe {
            let writer = DOWN.writer() as usize;
            stops[0] = look(watch, &PROBE, (&REQUESTS, writer), By::Probe);
            follow(&mut self.stopped_at[0], &PROBE);
        }
        #[cfg(feature = "serial")]
        if let Some(watch) = &mut self.serial {
            let (ring, looked) = serial::ring();
            stops[1] = look(watch, looked, (ring, serial::writer()), By::Serial);
            follow(&mut self.stopped_at[1], looked);
        }
        let is_stop = stops != [None; 2];
        if is_stop {
            self.stop_at(tick, stops);
        }
        is_stop
    }

    /// After so many bytes of each link. What has come by the other in the same tick came before.
    #[cold]
    #[inline(never)]
    fn stop_at(&mut self, tick: u32, stops: [Option<u32>; 2]) {
        STOPPED_IN.store(tick, Ordering::Relaxed);
        self.stop();
        if let [Some(at), None] | [None, Some(at)] = stops {
            self.stopped_at[usize::from(stops[0].is_none())] = at;
        }
    }

    /// What has come by now came before a stop.
    pub(crate) fn stop(&mut self) {
        self.stopped_at[0] = PROBE.bytes();
        #[cfg(feature = "serial")]
        {
            self.stopped_at[1] = serial::ring().1.bytes();
        }
    }

    /// Whether what had come with the last byte of a request came before a stop.
    pub(crate) fn is_before(&self, at: u32, by: By) -> bool {
        // Counts wrap around.
        at.wrapping_sub(self.stopped_at[by as usize]).cast_signed() <= 0
    }
}

/// Within half a round of the count, as far behind as no request is.
fn follow(stopped_at: &mut u32, looked: &Looked) {
    let since = looked.bytes().wrapping_sub(*stopped_at);
    if since > FAR {
        *stopped_at = stopped_at.wrapping_add(FAR / 2);
    }
}

/// A link as it is looked at: its ring, and where the next byte will be written.
type Arrived<'r> = (&'r [AtomicU8], usize);

/// How many bytes had come by a link with the last stop in it.
#[cold]
#[inline(never)]
fn look(
    watch: &mut StopWatch,
    looked: &Looked,
    (ring, writer): Arrived<'_>,
    by: By,
) -> Option<u32> {
    compiler_fence(Ordering::Acquire);
    let mut last = None;
    let mut at = looked.until(ring.len());
    while at != writer
        && let Some(byte) = ring.get(at)
    {
        let stop = watch.push(byte.load(Ordering::Relaxed));
        at = if at + 1 < ring.len() { at + 1 } else { 0 };
        if stop.is_some_and(|stop| owe(stop, by)) {
            last = Some(at);
        }
    }
    looked.is_at(writer, ring.len());
    last.map(|at| looked.bytes_until(at, ring.len()))
}

/// Has idle answer a stop; whether it is one: a probe's ring has no lines.
fn owe(stop: Stop, by: By) -> bool {
    let (owed, tag) = match (stop, by) {
        (Stop::Frame(tag), By::Probe) => (&OWED[0], tag),
        (Stop::Frame(tag), By::Serial) => (&OWED[1], tag),
        (Stop::Line, By::Serial) => (&OWED[2], 0),
        (Stop::Line, By::Probe) => return false,
    };
    owed.add(tag);
    true
}
