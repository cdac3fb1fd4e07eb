//! Why the chip was reset.

/// What resets the chip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ResetCause {
    /// The supply came.
    Power,
    /// The independent watchdog.
    Watchdog,
    /// The reset button.
    Pin,
    /// The core asked for it (SYSRESETREQ).
    Software,
    /// The supply fell below the level of the option bytes.
    BrownOut,
}
