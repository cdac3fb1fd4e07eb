//! Fatal faults: the motor's outputs go off first, then the record and the log get a line,
//! then the watchdog resets the chip. Waiting for it gives the probe time to
//! fetch the line. With a supply that falls there is no time for either.

use core::panic::PanicInfo;
use core::sync::atomic::{AtomicBool, Ordering};

use cortex_m::peripheral::SCB;
use cortex_m_rt::{ExceptionFrame, exception};
use firmware::faults::number;

use super::{log, outputs, retained, watchdog};
use crate::here::power;

/// Set by the first fault, so that a fault while its line is written adds none.
static DYING: AtomicBool = AtomicBool::new(false);

/// Motor off, the fault with this number to the record and to the log, `details` too, reset.
pub(crate) fn die(number: u8, details: impl FnOnce()) -> ! {
    if tell(number) {
        details();
    }
    watchdog::wait_for_reset()
}

/// For a supply that may be gone before a line is written: the next start has the line.
fn die_at_once(number: u8) -> ! {
    begin(number);
    SCB::sys_reset()
}

/// What every fault begins with; whether it is the first. Once in the program.
#[inline(never)]
fn tell(number: u8) -> bool {
    let first = begin(number);
    if first {
        log::fatal(number);
    }
    first
}

/// Motor off, and the fault to the record; whether it is the first.
fn begin(number: u8) -> bool {
    cortex_m::interrupt::disable();
    outputs::off();
    // No swap, which a Cortex-M0+ lacks: only a fault within a fault can come between.
    let first = !DYING.load(Ordering::Relaxed);
    DYING.store(true, Ordering::Relaxed);
    if first {
        retained::note(number);
    }
    first
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    die(number::PANIC, || {
        if let Some(place) = info.location() {
            defmt::error!("- at {=str}:{=u32}", place.file(), place.line());
        }
    })
}

#[allow(unsafe_code, reason = "a handler that needs no stack is no function")]
mod vector {
    //! The vector of the hard fault, in place of that of cortex-m-rt, which pushes. A stack
    //! without room has no frame, and none for a handler: that begins on a new one, as no code
    //! returns to the old.

    // SAFETY: run by the hardware only; it hands `hard_fault` what it expects, a frame or zero,
    // and a stack with room. MSP is the only stack pointer in use.
    core::arch::global_asm!(
        ".section .HardFaultTrampoline, \"ax\"",
        ".global HardFault",
        ".type HardFault,%function",
        ".thumb_func",
        "HardFault:",
        "mrs r0, MSP",
        "ldr r1, =_stack_end + {room}",
        "cmp r0, r1",
        "bhs 1f",
        "movs r0, #0",
        "ldr r1, =_stack_start",
        "msr MSP, r1",
        "1: ldr r1, ={handler}",
        "bx r1",
        ".ltorg",
        room = const super::HANDLER_ROOM,
        handler = sym super::hard_fault,
    );
}

/// What a hard fault pushes, and its handler needs, bytes.
const HANDLER_ROOM: usize = 512;

/// A hard fault; without a frame where the stack has no room left.
extern "C" fn hard_fault(frame: Option<&ExceptionFrame>) -> ! {
    let Some(frame) = frame else {
        die(number::STACK_OVERFLOW, || {});
    };
    die(number::HARD_FAULT, || {
        let [configurable, hard] = fault_status();
        defmt::error!(
            "- at {=u32:#x}, called from {=u32:#x}, CFSR {=u32:#x}, HFSR {=u32:#x}",
            frame.pc(),
            frame.lr(),
            configurable,
            hard
        );
    })
}

/// What the core says of a hard fault: CFSR and HFSR; nothing, on a Cortex-M0+.
fn fault_status() -> [u32; 2] {
    #[cfg(feature = "cortex-m0-plus")]
    return [0; 2];
    #[cfg(not(feature = "cortex-m0-plus"))]
    #[allow(unsafe_code, reason = "the SCB has no owner in a fault")]
    // SAFETY: status registers; reading them has no effect.
    unsafe {
        [(*SCB::PTR).cfsr.read(), (*SCB::PTR).hfsr.read()]
    }
}

#[allow(unsafe_code, reason = "cortex-m-rt asks for it")]
// SAFETY: called by the hardware only; it does not return, so whatever it interrupts is over.
#[exception]
unsafe fn NonMaskableInt() -> ! {
    if crate::here::has_clock_stopped() {
        die(number::CLOCK_STOPPED, || {});
    }
    die(number::STRAY_INTERRUPT, || defmt::error!("- non-maskable"))
}

#[allow(unsafe_code, reason = "cortex-m-rt asks for it")]
// SAFETY: called by the hardware only; it does not return, so whatever it interrupts is over.
#[exception]
unsafe fn DefaultHandler(interrupt: i16) -> ! {
    // The voltage detector has no handler of its own.
    if power::has_fallen() {
        die_at_once(number::SUPPLY_LOW);
    }
    die(number::STRAY_INTERRUPT, || {
        defmt::error!("- number {=i16}", interrupt);
    })
}
