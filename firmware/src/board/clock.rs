//! The clock tree: 8 MHz from the ST-LINK to 160 MHz, as derived in
//! [`timing`](super::timing); what debuggers stop; why the chip was reset.

use stm32f4xx_hal::pac::{DBGMCU, FLASH, RCC};

use super::timing;

/// Why the chip started.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum ResetCause {
    /// The independent watchdog: tick or idle stood still, or a fault handler waited for it.
    Watchdog,
    /// By software: a debugger or the programmer.
    Software,
    /// Supply came, or dipped.
    Power,
    /// The reset button, or the probe.
    Pin,
    /// None of these.
    Other,
}

/// Reads why the chip started and forgets it, so that the next start tells its own.
pub(crate) fn reset_cause(rcc: &RCC) -> ResetCause {
    let flags = rcc.csr().read();
    rcc.csr().modify(|_, w| w.rmvf().set_bit());
    // A power-up sets the pin's flag too, and so does every internal reset:
    // the most specific comes first.
    if flags.wdgrstf().bit_is_set() {
        ResetCause::Watchdog
    } else if flags.sftrstf().bit_is_set() {
        ResetCause::Software
    } else if flags.porrstf().bit_is_set() || flags.borrstf().bit_is_set() {
        ResetCause::Power
    } else if flags.padrstf().bit_is_set() {
        ResetCause::Pin
    } else {
        ResetCause::Other
    }
}

/// A clock that did not come.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum ClockError {
    /// Nothing on the HSE input.
    NoHse,
    /// The PLL did not lock.
    NoPll,
}

/// Goes from the internal 16 MHz to the clocks of [`timing`], and has the chip
/// raise the non-maskable interrupt should the ST-LINK's clock stop.
///
/// # Errors
/// The clock that did not come.
pub(crate) fn start(rcc: &RCC, flash: &FLASH) -> Result<(), ClockError> {
    rcc.cr().modify(|_, w| w.hsebyp().set_bit());
    rcc.cr().modify(|_, w| w.hseon().set_bit());
    wait(|| rcc.cr().read().hserdy().bit_is_set()).ok_or(ClockError::NoHse)?;

    rcc.pllcfgr().modify(|_, w| {
        w.pllsrc().hse().pllp().div2();
        #[allow(unsafe_code, reason = "the field has no checked setter")]
        // SAFETY: 4 and 160 are allowed dividers (2..=63 and 50..=432); the PLL is off.
        unsafe {
            w.pllm().bits(timing::PLL_M).plln().bits(timing::PLL_N)
        }
    });
    const { assert!(timing::PLL_P == 2) };
    rcc.cr().modify(|_, w| w.pllon().set_bit());
    wait(|| rcc.cr().read().pllrdy().bit_is_set()).ok_or(ClockError::NoPll)?;

    // Wait states before the clock that needs them.
    flash.acr().modify(|_, w| {
        w.prften().set_bit().icen().set_bit().dcen().set_bit();
        w.latency().set(timing::FLASH_WAIT_STATES)
    });
    wait(|| flash.acr().read().latency().bits() == timing::FLASH_WAIT_STATES)
        .ok_or(ClockError::NoPll)?;
    const { assert!(timing::APB1_HZ * 4 == timing::CORE_HZ) };
    const { assert!(timing::APB2_HZ * 2 == timing::CORE_HZ) };
    rcc.cfgr()
        .modify(|_, w| w.ppre1().div4().ppre2().div2().sw().pll());
    wait(|| rcc.cfgr().read().sws().is_pll()).ok_or(ClockError::NoPll)?;

    rcc.cr().modify(|_, w| w.csson().set_bit());
    Ok(())
}

fn wait(ready: impl Fn() -> bool) -> Option<()> {
    (0..timing::CLOCK_PATIENCE).any(|_| ready()).then_some(())
}

/// Keeps the log readable while the core sleeps, and lets a debugger that
/// halts the core stop the motor (TIM1 then takes its outputs low) and the
/// watchdog.
pub(crate) fn prepare_for_debuggers(debug: &DBGMCU) {
    debug.cr().modify(|_, w| w.dbg_sleep().set_bit());
    debug.apb2_fz().modify(|_, w| w.dbg_tim1_stop().set_bit());
    debug.apb1_fz().modify(|_, w| w.dbg_iwdg_stop().set_bit());
}
