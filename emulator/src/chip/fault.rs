//! What the emulated chip cannot go along with, and what resets it.

/// Why an emulated run ended early.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub(crate) enum Fault {
    /// The program touched a register that is not modelled: to carry on would be to guess.
    #[error("{} of {address:#010x} at pc {pc:#010x}: not modelled", if *.write { "write" } else { "read" })]
    Unmodelled { address: u32, write: bool, pc: u32 },
    #[error("clock tree: {0}")]
    Clock(&'static str),
    /// A peripheral is used in a way that is not modelled, or that its manual forbids.
    #[error("{peripheral}: {what}")]
    Misused {
        peripheral: &'static str,
        what: &'static str,
    },
    /// The sensor's wires are driven in a way that the sensor does not bear.
    #[error("{side} sensor's wires: {what}")]
    Wires {
        side: &'static str,
        what: &'static str,
    },
    /// A fault within a fault handler.
    #[error("the core locked up at pc {pc:#010x}")]
    LockUp { pc: u32 },
    #[error("the core sleeps and nothing will wake it")]
    Asleep,
    /// The program has not come to its first tick; its log.
    #[error("it does not start:\n  {0}")]
    NoStart(String),
    /// Within a run that must not be interrupted.
    #[error("the chip was reset by {0:?}")]
    Reset(ResetCause),
    #[error("a board of the head ticked not once while another did")]
    Unequal,
    /// A scene's sensor has no magnet that can be simulated.
    #[error("no such magnet")]
    NoMagnet,
    #[error("it has sent what cannot be read")]
    Garbled,
    /// The emulator's own memory map refused what it should not.
    #[error("memory: {0}")]
    Memory(String),
    /// The program file is not what the emulator needs.
    #[error("program: {0}")]
    Program(String),
}

impl From<rtt::BadProgram> for Fault {
    fn from(bad: rtt::BadProgram) -> Self {
        Self::Program(bad.to_string())
    }
}

/// What resets the chip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ResetCause {
    /// The supply came.
    Power,
    /// The independent watchdog.
    Watchdog,
    Pin,
    /// The core asked for it (SYSRESETREQ).
    Software,
    /// The supply fell below the level of the option bytes.
    BrownOut,
}
