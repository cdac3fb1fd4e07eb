//! The independent watchdog: resets the chip, and motors go off, when tick or idle stand still.

use stm32_metapac::IWDG;
use stm32_metapac::iwdg::vals::{Key, Pr};

use crate::here::CLOCKS;

/// Its counts while flash is erased and written, of 256 periods of its oscillator.
const SLOW_COUNTS: u16 = (4 * CLOCKS.watchdog_hz[2] / 256) as u16;

pub(crate) struct Watchdog(());

impl Watchdog {
    /// Nothing but a reset stops it.
    pub(crate) fn start() -> Self {
        key(Key::START);
        Self::set(Pr::DIVIDE_BY4, CLOCKS.watchdog_counts())
    }

    /// Longer than the flash takes to be erased, 2 s at most: 4 s where its oscillator is fastest,
    /// 11 s where it is slowest.
    pub(crate) fn slow() -> Self {
        Self::set(Pr::DIVIDE_BY256, SLOW_COUNTS)
    }

    fn set(prescaler: Pr, counts: u16) -> Self {
        key(Key::ENABLE);
        IWDG.pr().write(|w| w.set_pr(prescaler));
        IWDG.rlr().write(|w| w.set_rl(counts - 1));
        // Within five of its cycles, 300 µs; otherwise those before hold, half a second.
        let _ = (0..100_000).any(|_| IWDG.sr().read().0 == 0);
        let mut dog = Self(());
        dog.feed();
        dog
    }

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

/// Cycles that a Cortex-M0+, M3 or M4 takes for each cycle of delay that is asked for: the
/// loop takes three, or four with a slow branch.
const DELAY_CYCLES: u32 = 3;

/// The probe has time to fetch the last line; the watchdog bites within a second, started or not.
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
