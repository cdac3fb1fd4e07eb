//! What tick and idle ask of each other.

use core::sync::atomic::{AtomicBool, Ordering};

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
