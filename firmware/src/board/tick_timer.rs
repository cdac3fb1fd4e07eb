//! The timer that makes the ticks.

use firmware::boards::TickPeriod;
use stm32_metapac::timer::vals::Urs;

use crate::here::TICK_TIMER;

/// The first tick comes one period from now.
pub(crate) fn start(period: TickPeriod) {
    // Both are 1 or more.
    TICK_TIMER
        .psc()
        .write_value(period.prescaler.wrapping_sub(1));
    let last = period.period.wrapping_sub(1);
    TICK_TIMER.arr().write(|w| w.set_arr(last));
    // The prescaler takes effect with an update; that one is no tick.
    TICK_TIMER.cr1().write(|w| w.set_urs(Urs::COUNTER_ONLY));
    TICK_TIMER.egr().write(|w| w.set_ug(true));
    TICK_TIMER.dier().write(|w| w.set_uie(true));
    // A tick that has begun keeps its length: the count may be beyond a new one.
    #[cfg(feature = "bus")]
    TICK_TIMER.cr1().modify(|w| w.set_arpe(true));
    TICK_TIMER.cr1().modify(|w| w.set_cen(true));
}

/// Makes the next tick, and those after it, so many counts of the timer long.
#[cfg(feature = "bus")]
#[inline]
pub(crate) fn set_next(counts: u16) {
    TICK_TIMER
        .arr()
        .write(|w| w.set_arr(counts.wrapping_sub(1)));
}

#[inline]
pub(crate) fn acknowledge() {
    TICK_TIMER.sr().write(|w| w.set_uif(false));
}
