//! Why a chip started, and what may keep it from starting.

/// Why the chip started.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Cause {
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

impl Cause {
    /// The first whose flag is set in the reset status register. The most
    /// specific must come first: a power-up sets the pin's flag too, and so does
    /// every internal reset.
    pub(crate) fn first(flags: [(bool, Self); 4]) -> Self {
        let set = flags.into_iter().find(|(set, _)| *set);
        set.map_or(Self::Other, |(_, cause)| cause)
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

/// Waits until `ready`, within [`CLOCK_WAIT_LOOPS`](super::timing::CLOCK_WAIT_LOOPS).
///
/// # Errors
/// `error` if it did not come.
pub(crate) fn wait(error: ClockError, ready: impl Fn() -> bool) -> Result<(), ClockError> {
    let came = (0..super::timing::CLOCK_WAIT_LOOPS).any(|_| ready());
    if came { Ok(()) } else { Err(error) }
}

/// A peripheral answers two cycles after its clock came (errata sheet of the
/// STM32F4, RM0444).
pub(crate) fn settle() {
    cortex_m::asm::dsb();
}
