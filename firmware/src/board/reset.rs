//! What may keep a chip from starting.

use firmware::boards::CLOCK_WAIT_LOOPS;

/// A clock that did not come.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum ClockError {
    /// Nothing on the HSE input.
    NoHse,
    /// The PLL did not lock.
    NoPll,
}

/// Waits until `ready`, within [`CLOCK_WAIT_LOOPS`].
///
/// # Errors
/// `error` if it did not come.
pub(crate) fn wait(error: ClockError, ready: impl Fn() -> bool) -> Result<(), ClockError> {
    let came = (0..CLOCK_WAIT_LOOPS).any(|_| ready());
    if came { Ok(()) } else { Err(error) }
}

/// A peripheral answers two cycles after its clock came (errata sheet of the
/// STM32F4, RM0444).
pub(crate) fn settle() {
    cortex_m::asm::dsb();
}
