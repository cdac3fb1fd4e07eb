//! How fast the module ticks, for lines of the log and whoever else has no access to its
//! settings: set once, at the start.

use core::sync::atomic::{AtomicU32, Ordering};

use firmware::boards::Clocks;

use super::reset::ClockSource;
use crate::here::FACTS;

/// By the clock from outside and by the chip's oscillator; as they are and as slow sensors need
/// them.
static CLOCKS: [[Clocks; 2]; 2] = [
    [FACTS.clocks, FACTS.clocks.halved()],
    [FACTS.clocks_internal, FACTS.clocks_internal.halved()],
];

/// Ticks a second, whether the clock is halved, and whether it is the chip's own.
static PACE: [AtomicU32; 3] = [const { AtomicU32::new(0) }; 3];

/// Sets the first two, before the first tick and the first line.
pub(crate) fn set(tick_hz: u32, is_slow: bool) {
    let [rate, slow, _] = &PACE;
    rate.store(tick_hz, Ordering::Relaxed);
    slow.store(is_slow.into(), Ordering::Relaxed);
}

/// Sets the third, once it is known.
pub(crate) fn runs_by(source: ClockSource) {
    let is_internal = source == ClockSource::Internal;
    PACE[2].store(is_internal.into(), Ordering::Relaxed);
}

pub(crate) fn is_internal() -> bool {
    PACE[2].load(Ordering::Relaxed) != 0
}

#[inline]
pub(crate) fn tick_hz() -> u32 {
    PACE[0].load(Ordering::Relaxed).max(1)
}

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

pub(crate) fn clocks() -> &'static Clocks {
    let [[own, halved], [internal, internal_halved]] = &CLOCKS;
    match (PACE[1].load(Ordering::Relaxed) != 0, is_internal()) {
        (false, false) => own,
        (true, false) => halved,
        (false, true) => internal,
        (true, true) => internal_halved,
    }
}

pub(crate) const fn constants() -> &'static [AtomicU32; 3] {
    &PACE
}
