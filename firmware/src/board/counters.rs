//! Counts with one writer, which a Cortex-M0+ can have too.

use core::sync::atomic::{AtomicU32, Ordering};

/// Ticks since the start. Only the tick counts it up.
pub(crate) static TICKS: WrappingCounter = WrappingCounter::new();

/// A count; wraps around.
pub(crate) struct WrappingCounter(AtomicU32);

impl WrappingCounter {
    /// Zero.
    pub(crate) const fn new() -> Self {
        Self(AtomicU32::new(0))
    }

    /// One more, for the only writer. A load and a store, because a Cortex-M0+
    /// has no instruction that does both.
    #[inline]
    pub(crate) fn increment(&self) {
        self.0.store(self.get().wrapping_add(1), Ordering::Relaxed);
    }

    /// The count.
    #[inline]
    pub(crate) fn get(&self) -> u32 {
        self.0.load(Ordering::Relaxed)
    }
}
