//! What the starts of chips have in common, and what may keep one from it.

use firmware::boards::CLOCK_WAIT_LOOPS;
use stm32_metapac::RCC;
use stm32_metapac::rcc::vals::Hpre;

/// A clock that a board cannot run without did not come.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct NoClock;

#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum ClockSource {
    /// By the clock that it is made for.
    Own,
    /// By the chip's oscillator, as nothing comes from outside: that of the ST-LINK comes once a PC
    /// has greeted it, late or, on a supply without a PC, never.
    Internal,
}

impl ClockSource {
    pub(crate) const fn of(is_fed: bool) -> Self {
        if is_fed { Self::Own } else { Self::Internal }
    }
}

pub(crate) fn comes(ready: impl Fn() -> bool) -> bool {
    (0..CLOCK_WAIT_LOOPS).any(|_| ready())
}

pub(crate) fn wait(ready: impl Fn() -> bool) -> Result<(), NoClock> {
    if comes(ready) { Ok(()) } else { Err(NoClock) }
}

/// A peripheral answers two cycles after its clock came (errata sheet of the STM32F4, RM0444).
pub(crate) fn settle() {
    cortex_m::asm::dsb();
}

/// Halves all clocks but the watchdog's: the core's is divided before it comes to the buses.
pub(crate) fn halve_clocks() {
    RCC.cfgr().modify(|w| w.set_hpre(Hpre::DIV2));
}
