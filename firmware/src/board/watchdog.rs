//! The independent watchdog: resets the chip, and with it takes the motor's
//! outputs off, when tick or idle stand still.

use stm32_metapac::IWDG;
use stm32_metapac::iwdg::vals::{Key, Pr};

use crate::here::CLOCKS;

/// The running watchdog.
pub(crate) struct Watchdog(());

impl Watchdog {
    /// Starts it; nothing but a reset stops it.
    pub(crate) fn start() -> Self {
        key(Key::START);
        key(Key::ENABLE);
        IWDG.pr().write(|w| w.set_pr(Pr::DIVIDE_BY4));
        IWDG.rlr().write(|w| w.set_rl(CLOCKS.watchdog_counts() - 1));
        // The settings cross into the watchdog's clock within five of its
        // cycles, 300 µs at most. Should they not, the settings after reset
        // hold, half a second.
        let _ = (0..100_000).any(|_| IWDG.sr().read().0 == 0);
        let mut dog = Self(());
        dog.feed();
        dog
    }

    /// Lets it begin its count anew.
    #[inline]
    pub(crate) fn feed(&mut self) {
        key(Key::RESET);
    }
}

#[inline]
fn key(key: Key) {
    IWDG.kr().write(|w| w.set_key(key));
}

/// How often a fault handler feeds before the reset, every quarter of a
/// millisecond: a quarter of a second and more, for the probe to fetch the log.
const LAST_WORDS: u32 = 1_000;

/// Gives the probe time to fetch the last words, then waits for the watchdog,
/// started now if it was not: some ten milliseconds more if it runs, up to a
/// second otherwise.
pub(crate) fn wait_for_reset() -> ! {
    for _ in 0..LAST_WORDS {
        key(Key::RESET);
        // At a tenth of the clock, should the PLL have gone, this is in time too.
        cortex_m::asm::delay(CLOCKS.core_hz / 4_000);
    }
    key(Key::START);
    loop {
        cortex_m::asm::nop();
    }
}
