//! The independent watchdog: resets the chip, and with it takes the motor's
//! outputs off, when tick or idle stand still.

use stm32f4xx_hal::pac::IWDG;

use super::timing::{CORE_HZ, WATCHDOG_COUNTS};

/// The running watchdog.
pub(crate) struct Watchdog {
    dog: IWDG,
}

impl Watchdog {
    /// Starts it; nothing but a reset stops it.
    pub(crate) fn start(dog: IWDG) -> Self {
        dog.kr().write(|w| w.key().start());
        dog.kr().write(|w| w.key().unlock());
        dog.pr().write(|w| w.pr().divide_by4());
        dog.rlr().write(|w| w.rl().set(WATCHDOG_COUNTS - 1));
        // The settings cross into the watchdog's clock within five of its
        // cycles, 300 µs at most. Should they not, the settings after reset
        // hold, half a second.
        let _ = (0..100_000).any(|_| dog.sr().read().bits() == 0);
        let mut dog = Self { dog };
        dog.feed();
        dog
    }

    /// Lets it begin its count anew.
    #[inline]
    pub(crate) fn feed(&mut self) {
        self.dog.kr().write(|w| w.key().feed());
    }
}

/// How often a fault handler feeds before the reset, every quarter of a
/// millisecond: a quarter of a second and more, for the probe to fetch the log.
const LAST_WORDS: u32 = 1_000;

/// Gives the probe time to fetch the last words, then waits for the watchdog,
/// started now if it was not: 13 to 38 ms more if it runs, up to a second
/// otherwise.
pub(crate) fn wait_for_reset() -> ! {
    #[allow(unsafe_code, reason = "the owner of the watchdog will not run again")]
    // SAFETY: the register takes keys only; starting a running watchdog changes nothing.
    let dog = unsafe { IWDG::steal() };
    for _ in 0..LAST_WORDS {
        dog.kr().write(|w| w.key().feed());
        // At a tenth of the clock, should the PLL have gone, this is in time too.
        cortex_m::asm::delay(CORE_HZ / 4_000);
    }
    dog.kr().write(|w| w.key().start());
    loop {
        cortex_m::asm::nop();
    }
}
