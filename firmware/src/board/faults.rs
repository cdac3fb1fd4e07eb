//! Fatal faults: the motor's outputs go off first, then the record and the log get a line,
//! then the watchdog resets the chip. Waiting for it gives the probe time to
//! fetch the line.

use core::panic::PanicInfo;
use core::sync::atomic::{AtomicBool, Ordering};

use cortex_m_rt::{ExceptionFrame, exception};
use firmware::faults::number;

use super::{log, outputs, retained, watchdog};

/// Set by the first fault, so that a fault while its line is written adds none.
static DYING: AtomicBool = AtomicBool::new(false);

/// Motor off, the fault with this number to the record and to the log, `details` too, reset.
pub(crate) fn die(number: u8, details: impl FnOnce()) -> ! {
    cortex_m::interrupt::disable();
    outputs::off();
    // A load and a store, because a Cortex-M0+ has no swap; only a fault within
    // a fault can come between.
    let first = !DYING.load(Ordering::Relaxed);
    DYING.store(true, Ordering::Relaxed);
    if first {
        retained::note(number);
        log::fatal(number);
        details();
    }
    watchdog::wait_for_reset()
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    die(number::PANIC, || {
        if let Some(place) = info.location() {
            defmt::error!("- at {=str}:{=u32}", place.file(), place.line());
        }
    })
}

#[allow(unsafe_code, reason = "cortex-m-rt asks for it")]
// SAFETY: called by the hardware only; it does not return, so whatever it interrupts is over.
#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    die(number::HARD_FAULT, || {
        let [configurable, hard] = crate::here::fault_status();
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
    die(number::CLOCK_STOPPED, || {})
}

#[allow(unsafe_code, reason = "cortex-m-rt asks for it")]
// SAFETY: called by the hardware only; it does not return, so whatever it interrupts is over.
#[exception]
unsafe fn DefaultHandler(interrupt: i16) -> ! {
    die(number::STRAY_INTERRUPT, || {
        defmt::error!("- number {=i16}", interrupt);
    })
}
