//! Sleep until an interrupt.

/// Waits for an interrupt.
///
/// While the debug unit keeps clocks running in sleep, what a core fetches after it woke may be
/// wrong (errata of the STM32F405, F411 and F412, "Debugging Sleep/Stop mode with WFE/WFI entry",
/// where the instruction stands at an address that ends in 4; others have seen it on more parts, and
/// with interrupts masked, as the loader's are). So it stands where that address cannot be, and the
/// barrier fetches again.
#[allow(
    unsafe_code,
    reason = "the place of an instruction is no concern of Rust's"
)]
#[inline(never)]
pub(crate) fn until_interrupt() {
    // SAFETY: waits and fetches again; registers, flags and memory stay as they are.
    unsafe {
        core::arch::asm!(
            ".p2align 3",
            "wfi",
            "isb",
            options(nostack, preserves_flags)
        );
    }
}
