//! The independent watchdog: resets the chip, which switches the motor's
//! outputs off, when tick or idle stand still.

use stm32_metapac::IWDG;
use stm32_metapac::iwdg::vals::{Key, Pr};

use super::CLOCKS;

/// Its counts while flash is erased and written, of 256 periods of its oscillator.
const SLOW_COUNTS: u16 = (4 * CLOCKS.watchdog_hz[2] / 256) as u16;

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

    /// Has it wait longer than the flash takes to be erased, which is 2 s at most: 4 s where
    /// its oscillator is fastest, 11 s where it is slowest.
    pub(crate) fn slow_down() {
        key(Key::ENABLE);
        IWDG.pr().write(|w| w.set_pr(Pr::DIVIDE_BY256));
        IWDG.rlr().write(|w| w.set_rl(SLOW_COUNTS - 1));
        let _ = (0..100_000).any(|_| IWDG.sr().read().0 == 0);
        key(Key::RESET);
    }

    /// Restarts its count, where whoever does it has the chip for itself.
    pub(crate) fn feed_slow() {
        key(Key::RESET);
    }

    /// Restarts its count.
    #[inline]
    pub(crate) fn feed(&mut self) {
        key(Key::RESET);
    }
}

#[inline]
fn key(key: Key) {
    IWDG.kr().write(|w| w.set_key(key));
}

/// Feeds of a fault handler before the reset, one every quarter of a
/// millisecond: a quarter of a second and more, for the probe to fetch the log.
const LAST_FEEDS: u32 = 1_000;

/// Cycles that a Cortex-M0+, M3 or M4 takes for each that the delay is told: its loop takes
/// three, or four with a slow branch.
const DELAY_CYCLES: u32 = 3;

/// Gives the probe time to fetch the last line, then waits for the watchdog,
/// started now if it was not: some ten milliseconds more if it runs, up to a
/// second otherwise.
#[inline(never)]
pub(crate) fn wait_for_reset() -> ! {
    for _ in 0..LAST_FEEDS {
        key(Key::RESET);
        // In time even at a tenth of the clock, should the PLL have failed.
        cortex_m::asm::delay(CLOCKS.core_hz / 4_000 / DELAY_CYCLES);
    }
    key(Key::START);
    loop {
        cortex_m::asm::nop();
    }
}
