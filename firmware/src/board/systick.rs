//! The core's SysTick as a clock that measures ticks. It counts on while the
//! core sleeps, as the core's cycle counter may not.

use cortex_m::peripheral::{SYST, syst::SystClkSource};
use firmware::Clock;

/// 24 bits at the core's clock, widened to 32: right while it is read within 0.2 s, as each tick
/// does.
pub(crate) struct SysTick {
    last: u32,
    now: u32,
}

impl SysTick {
    const MASK: u32 = 0x00FF_FFFF;

    pub(crate) fn start(core: cortex_m::Peripherals) -> Self {
        let mut timer = core.SYST;
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(Self::MASK);
        timer.clear_current();
        timer.enable_counter();
        Self { last: 0, now: 0 }
    }

    /// One more, from now on, of the timer that runs.
    #[cfg(feature = "bus")]
    pub(crate) fn running() -> Self {
        Self {
            last: SYST::get_current(),
            now: 0,
        }
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
