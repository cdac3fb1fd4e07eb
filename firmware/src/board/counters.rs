//! Counts with one writer, which a Cortex-M0+ can have too.

use core::sync::atomic::{AtomicU32, Ordering};

/// Ticks since the start. Only the tick counts it up.
pub(crate) static TICKS: WrappingCounter = WrappingCounter::new();

/// The longest tick of the last whole second, in counts of the clock. Only the tick
/// sets it.
pub(crate) static WORST: WrappingCounter = WrappingCounter::new();

/// Ticks missed since the start, as of the last whole second. Only the tick sets it.
pub(crate) static MISSED: WrappingCounter = WrappingCounter::new();

pub(crate) struct WrappingCounter(AtomicU32);

impl WrappingCounter {
    pub(crate) const fn new() -> Self {
        Self(AtomicU32::new(0))
    }

    /// One more, for the only writer; the new count. A load and a store, because a
    /// Cortex-M0+ has no instruction that does both.
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
