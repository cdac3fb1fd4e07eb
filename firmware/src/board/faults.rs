//! Fatal faults: the motor's outputs go off first, then the log gets a line,
//! then the watchdog resets the chip. Waiting for it gives the probe time to
//! fetch the line.

use core::panic::PanicInfo;
use core::sync::atomic::{AtomicBool, Ordering};

use cortex_m_rt::{ExceptionFrame, exception};
use firmware::faults::number;

use super::{log, outputs, watchdog};

/// Set by the first fault, so that a fault while its line is written adds none.
static DYING: AtomicBool = AtomicBool::new(false);

/// Motor off, `last_line` to the log, reset.
pub(crate) fn die(last_line: impl FnOnce()) -> ! {
    cortex_m::interrupt::disable();
    outputs::off();
    // A load and a store, because a Cortex-M0+ has no swap; only a fault within
    // a fault can come between.
    let first = !DYING.load(Ordering::Relaxed);
    DYING.store(true, Ordering::Relaxed);
    if first {
        last_line();
    }
    watchdog::wait_for_reset()
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    die(|| {
        log::fatal(number::PANIC);
        if let Some(place) = info.location() {
            defmt::error!("- at {=str}:{=u32}", place.file(), place.line());
        }
    })
}

#[allow(unsafe_code, reason = "cortex-m-rt asks for it")]
// SAFETY: called by the hardware only; it does not return, so whatever it interrupts is over.
#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    die(|| {
        let [configurable, hard] = crate::here::fault_status();
        log::fatal(number::HARD_FAULT);
        defmt::error!(
            "- at {=u32:#x}, called from {=u32:#x}, CFSR {=u32:#x}, HFSR {=u32:#x}",
            frame.pc(),
            frame.lr(),
            configurable,
            hard
        );
    })
}

#[allow(unsafe_code, reason = "cortex-m-rt asks for it")]
// SAFETY: called by the hardware only; it does not return, so whatever it interrupts is over.
#[exception]
unsafe fn NonMaskableInt() -> ! {
    die(|| log::fatal(number::CLOCK_STOPPED))
}

#[allow(unsafe_code, reason = "cortex-m-rt asks for it")]
// SAFETY: called by the hardware only; it does not return, so whatever it interrupts is over.
#[exception]
unsafe fn DefaultHandler(interrupt: i16) -> ! {
    die(|| {
        log::fatal(number::STRAY_INTERRUPT);
        defmt::error!("- number {=i16}", interrupt);
    })
}
