//! How fast the module ticks, for lines of the log and whoever else has no access to its
//! settings: set once, at the start.

use core::sync::atomic::{AtomicU32, Ordering};

use firmware::boards::Clocks;

use crate::here::CLOCKS;

/// The clocks of this board as slow sensors need them.
const HALVED: Clocks = CLOCKS.halved();

/// Ticks a second, and whether the clock is halved.
static PACE: [AtomicU32; 2] = [AtomicU32::new(0), AtomicU32::new(0)];

/// Sets both, before the first tick and the first line.
pub(crate) fn set(tick_hz: u32, is_slow: bool) {
    let [rate, slow] = &PACE;
    rate.store(tick_hz, Ordering::Relaxed);
    slow.store(is_slow.into(), Ordering::Relaxed);
}

/// Ticks a second; 1 or more.
#[inline]
pub(crate) fn tick_hz() -> u32 {
    PACE[0].load(Ordering::Relaxed).max(1)
}

/// A tick, µs.
pub(crate) fn period_us() -> u32 {
    1_000_000 / tick_hz()
}

/// So many counts of the clock in tenths of a microsecond, as far as they go.
pub(crate) fn tenths(counts: u32) -> u16 {
    let us = (clocks().counter_hz / 1_000_000).max(1);
    // In two steps, lest ten times the counts overflow.
    let tenths = (counts / us).saturating_mul(10) + counts % us * 10 / us;
    tenths.min(u16::MAX.into()) as u16
}

/// The clocks as they run once the start has halved them or not.
pub(crate) fn clocks() -> &'static Clocks {
    if PACE[1].load(Ordering::Relaxed) == 0 {
        &CLOCKS
    } else {
        &HALVED
    }
}

/// What stays as it is from the start on.
pub(crate) const fn constants() -> &'static [AtomicU32; 2] {
    &PACE
}
