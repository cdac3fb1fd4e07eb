//! The supply: where it falls below what the clock needs, motors go off and the chip is reset.
//! The clock that it then has needs less, and the start waits with it until the supply is back.
//!
//! The chip's voltage detector interrupts at the highest priority, which no lock and no other
//! interrupt holds off; its thresholds are in `power_*.rs`. Its vector is that of the
//! interrupts without a handler, [`faults`](super::faults).

use cortex_m::peripheral::NVIC;
use stm32_metapac::{EXTI, Interrupt};

use super::log;
use crate::here::power;

/// The detector's line in EXTI, on all chips.
pub(crate) const LINE: usize = 16;

/// Looks after which a supply that is still low gets a line in the log: a few milliseconds,
/// within which the detector has started.
const PATIENCE_LOOKS: u32 = 10_000;

/// Waits until there is enough of a supply for the clock; from then on its fall interrupts.
pub(crate) fn start() {
    power::start();
    EXTI.rtsr(0).modify(|w| w.set_line(LINE, true));
    if (0..PATIENCE_LOOKS).all(|_| power::is_low()) {
        log::waits_for_supply();
    }
    loop {
        while power::is_low() {}
        power::forget();
        // A fall from here on is kept until the interrupt is let through.
        if !power::is_low() {
            break;
        }
    }
    EXTI.imr(0).modify(|w| w.set_line(LINE, true));
    #[allow(unsafe_code, reason = "cortex-m asks for it")]
    // SAFETY: its handler does not return, so no data are at stake; its priority, that
    // after a reset, is above every mask of a task.
    unsafe {
        NVIC::unmask(Interrupt::PVD);
    }
    if power::brown_out_is_low() {
        log::brown_out_is_low();
    }
}
