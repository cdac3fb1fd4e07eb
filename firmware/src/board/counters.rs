//! What tick and idle share: counts with one writer, and what they ask of each other.

use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};

/// Ticks since the start. Only the tick counts it up.
pub(crate) static TICKS: WrappingCounter = WrappingCounter::new();

/// The longest tick of the last whole second, in counts of the clock. Only the tick sets it.
pub(crate) static WORST: WrappingCounter = WrappingCounter::new();

/// Ticks missed since the start, as of the last whole second. Only the tick sets it.
pub(crate) static MISSED: WrappingCounter = WrappingCounter::new();

pub(crate) struct WrappingCounter(AtomicU32);

impl WrappingCounter {
    pub(crate) const fn new() -> Self {
        Self(AtomicU32::new(0))
    }

    /// One more, for the only writer: a load and a store, as a Cortex-M0+ has no instruction for
    /// both.
    #[inline]
    pub(crate) fn increment(&self) -> u32 {
        let count = self.get().wrapping_add(1);
        self.set(count);
        count
    }

    #[inline]
    pub(crate) fn set(&self, count: u32) {
        self.0.store(count, Ordering::Relaxed);
    }

    #[inline]
    pub(crate) fn get(&self) -> u32 {
        self.0.load(Ordering::Relaxed)
    }
}

/// Something that is to be done once.
pub(crate) struct Request(AtomicBool);

impl Request {
    pub(crate) const fn none() -> Self {
        Self(AtomicBool::new(false))
    }

    pub(crate) fn make(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether it is to be done now. A load and a store, because a Cortex-M0+ has no swap: what is
    /// asked for again between both was asked for before it is done.
    #[inline]
    pub(crate) fn take(&self) -> bool {
        let is_made = self.0.load(Ordering::Relaxed);
        if is_made {
            self.0.store(false, Ordering::Relaxed);
        }
        is_made
    }
}
