//! The emulated machine: start, timer, and a call whose instructions are counted.
//!
//! The emulator lets one instruction take exactly 1.024 µs of its own time
//! (`-icount shift=10`), and SysTick, which every Cortex-M has, counts that
//! time at the processor's clock: 25.6 or 16.4 counts an instruction, so that
//! a difference of two readings gives the number of instructions between them
//! without doubt, up to 600,000 of them. [`crate::check`] makes sure of it.
//!
//! Counted are the call, the body and the return. The arguments are in their
//! registers before the first reading of the timer, by [`gate`], through which
//! every counted call goes.

// What stands here cannot be said in safe Rust: a processor's first
// instructions, its timer's registers, and a call between two instructions.
#![allow(
    unsafe_code,
    reason = "see above; nothing else in these programs is unsafe but the name of their start"
)]

use core::arch::{global_asm, naked_asm};
use core::mem::transmute;
use core::sync::atomic::{AtomicU32, Ordering};

unsafe extern "C" {
    /// Of the program: see [`crate::program!`].
    safe fn start() -> !;
}

/// The processor's clock, Hz.
const CLOCK_HZ: u64 = if cfg!(machine = "mps2-an386") {
    25_000_000
} else {
    16_000_000
};

/// Emulated time of one instruction, ns.
const INSTRUCTION_NS: u64 = 1 << 10;

/// Instructions from one reading of the timer to the next that are not the
/// call's: the second reading itself.
const READING: u32 = 1;

const SYST_CSR: *mut u32 = 0xE000_E010 as *mut u32;
const SYST_RVR: *mut u32 = 0xE000_E014 as *mut u32;
const SYST_CVR: *mut u32 = 0xE000_E018 as *mut u32;

/// Enabled, at the processor's clock.
const CSR_RUN: u32 = 0b101;
/// The counter reached zero since this was last read.
const CSR_WRAPPED: u32 = 1 << 16;
/// The counter has 24 bits and counts down.
const COUNTER: u32 = 0x00FF_FFFF;

/// [`gate`]'s memory, because nothing may be put on the stack between a caller
/// and a callee that finds arguments there: r4, r5, r6, lr, the kernel's
/// address, and the timer before and after.
static GATE: [AtomicU32; 7] = [const { AtomicU32::new(0) }; 7];
const KERNEL: usize = 4;
const BEFORE: usize = 5;
const AFTER: usize = 6;

// The vector table: stack, start, and the same end for every exception.
global_asm!(
    ".section .vector_table, \"a\"",
    ".global vector_table",
    "vector_table:",
    ".word stack_top",
    ".word {reset}",
    ".rept 14",
    ".word {fault}",
    ".endr",
    ".text",
    reset = sym reset,
    fault = sym fault,
);

/// The first instructions: switch the floating-point unit on where there is one.
#[cfg(machine = "mps2-an386")]
#[unsafe(naked)]
extern "C" fn reset() {
    // CPACR: full access to coprocessors 10 and 11.
    naked_asm!(
        "ldr r0, 2f",
        "ldr r1, [r0]",
        "orr r1, r1, #(15 << 20)",
        "str r1, [r0]",
        "dsb",
        "isb",
        "bl {start}",
        ".p2align 2",
        "2: .word 0xE000ED88",
        start = sym start,
    )
}

/// The first instruction.
#[cfg(machine = "microbit")]
#[unsafe(naked)]
extern "C" fn reset() {
    naked_asm!("bl {start}", start = sym start)
}

/// Any exception is a mistake in this program.
extern "C" fn fault() -> ! {
    panic!("the processor took an exception");
}

/// Starts the timer.
pub fn begin() {
    // SAFETY: SysTick's registers, which every Cortex-M has at these
    // addresses and which nothing else here touches.
    unsafe {
        SYST_RVR.write_volatile(COUNTER);
        SYST_CVR.write_volatile(0);
        SYST_CSR.write_volatile(CSR_RUN);
    }
}

/// Starts the timer again.
fn rewind() {
    // SAFETY: as in `begin`. A write of any value sets the counter to zero, from
    // where it goes on at its top.
    unsafe {
        SYST_CVR.write_volatile(0);
        while SYST_CVR.read_volatile() == 0 {}
    }
    // That zero was none of the kernel's.
    let _ = wrapped();
}

/// Whether the timer has come round since this was last asked.
fn wrapped() -> bool {
    // SAFETY: as in `begin`; reading clears the flag, which nothing else uses.
    unsafe { SYST_CSR.read_volatile() & CSR_WRAPPED != 0 }
}

/// Calls the kernel whose address stands in [`GATE`] and notes the timer right
/// before and right after. All arguments, on the stack or in registers, and all
/// results pass through untouched: it has the type of any kernel.
#[unsafe(naked)]
extern "C" fn gate() {
    naked_asm!(
        "mov r12, r4",
        "ldr r4, 2f",
        "str r5, [r4, #4]",
        "str r6, [r4, #8]",
        "mov r5, r12",
        "str r5, [r4]",
        "mov r5, lr",
        "str r5, [r4, #12]",
        "ldr r5, [r4, #16]",
        "mov r12, r5",
        "ldr r6, 3f",
        "ldr r5, [r6]",
        "blx r12",
        "ldr r6, [r6]",
        "str r5, [r4, #20]",
        "str r6, [r4, #24]",
        "ldr r5, [r4, #12]",
        "mov lr, r5",
        "ldr r5, [r4, #4]",
        "ldr r6, [r4, #8]",
        "ldr r4, [r4]",
        "bx lr",
        ".p2align 2",
        "2: .word {memory}",
        "3: .word 0xE000E018",
        memory = sym GATE,
    )
}

/// Calls `kernel(input, state)` and gives its instructions: call, body and return.
///
/// # Panics
/// If it ran for longer than the timer counts.
pub fn instructions<I, S, O>(
    kernel: extern "C" fn(I, &mut S) -> O,
    input: I,
    state: &mut S,
) -> u32 {
    GATE[KERNEL].store(kernel as usize as u32, Ordering::SeqCst);
    // SAFETY: `gate` hands every argument and result of the kernel through, and
    // keeps the registers that a callee must keep: called as a kernel's type it
    // does what that kernel does.
    let gated: extern "C" fn(I, &mut S) -> O =
        unsafe { transmute::<extern "C" fn(), extern "C" fn(I, &mut S) -> O>(gate) };
    rewind();
    core::hint::black_box(gated(input, state));
    assert!(!wrapped(), "longer than the timer counts");
    let before = GATE[BEFORE].load(Ordering::SeqCst);
    let after = GATE[AFTER].load(Ordering::SeqCst);
    let counts = u64::from(before.wrapping_sub(after) & COUNTER);
    // The nearest whole number.
    let per_second = CLOCK_HZ * INSTRUCTION_NS;
    let instructions = (counts * 1_000_000_000 + per_second / 2) / per_second;
    instructions as u32 - READING
}

/// `N` instructions that do nothing.
#[unsafe(naked)]
pub extern "C" fn nops<const N: usize>(_input: u32, _state: &mut ()) {
    naked_asm!(".rept {n}", "nop", ".endr", "bx lr", n = const N)
}

/// A loop of two instructions.
#[unsafe(naked)]
pub extern "C" fn turns(_turns: u32, _state: &mut ()) {
    naked_asm!("2:", "subs r0, #1", "bne 2b", "bx lr")
}
