//! Time: one timer makes the ticks, and something that counts on while the
//! core sleeps measures them (not the core's cycle counter, which may stand
//! still then).

use cortex_m::peripheral::{SYST, syst::SystClkSource};
use firmware::Clock;
use stm32_metapac::timer::vals::Urs;

use super::timing::TickPeriod;
use crate::here::TICK_TIMER;

/// The timer that interrupts once a tick.
pub(crate) struct TickTimer(());

impl TickTimer {
    /// The first tick comes one period from now.
    pub(crate) fn start(period: TickPeriod) -> Self {
        TICK_TIMER.psc().write_value(period.prescaler - 1);
        TICK_TIMER.arr().write(|w| w.set_arr(period.period - 1));
        // The prescaler takes effect with an update; that one is no tick.
        TICK_TIMER.cr1().write(|w| w.set_urs(Urs::COUNTER_ONLY));
        TICK_TIMER.egr().write(|w| w.set_ug(true));
        TICK_TIMER.dier().write(|w| w.set_uie(true));
        TICK_TIMER.cr1().modify(|w| w.set_cen(true));
        Self(())
    }

    /// The interrupt has been seen.
    #[inline]
    pub(crate) fn acknowledge(&mut self) {
        TICK_TIMER.sr().write(|w| w.set_uif(false));
    }
}

/// The core's SysTick, 24 bits at the core's clock, widened to 32 by whoever
/// asks. Right as long as it is asked within its round (0.2 s at 80 MHz); each
/// tick asks twice.
pub(crate) struct SysTick {
    last: u32,
    now: u32,
}

impl SysTick {
    const MASK: u32 = 0x00FF_FFFF;

    /// Counts from now on.
    pub(crate) fn start(mut timer: SYST) -> Self {
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(Self::MASK);
        timer.clear_current();
        timer.enable_counter();
        Self { last: 0, now: 0 }
    }
}

impl Clock for SysTick {
    #[inline]
    fn now(&mut self) -> u32 {
        let current = SYST::get_current();
        // It counts down.
        let elapsed = self.last.wrapping_sub(current) & Self::MASK;
        self.last = current;
        self.now = self.now.wrapping_add(elapsed);
        self.now
    }
}
