//! The chip's memory, read and written while the core runs.
//!
//! probe-rs's own session halts the core as it attaches and as it ends, to clear breakpoints. A
//! motor would be driven on meanwhile. To talk with a module its memory port is enough.

use host_sim::Error;
use probe_rs::architecture::arm::dp::DpAddress;
use probe_rs::architecture::arm::sequences::DefaultArmSequence;
use probe_rs::architecture::arm::{ArmDebugInterface, ArmError, FullyQualifiedApAddress};
use probe_rs::probe::{Probe, WireProtocol};
use rtt::Ram;

use crate::source::BoardName;

/// The register that resets the chip (AIRCR), and what asks for it (Armv7-M Architecture
/// Reference Manual, "Application Interrupt and Reset Control Register"; Armv6-M has the same).
const RESET_CONTROL: u32 = 0xE000_ED0C;
const RESET: u32 = 0x05FA_0004;

/// The memory port behind a probe.
pub(super) struct MemoryPort {
    interface: Box<dyn ArmDebugInterface + 'static>,
}

impl MemoryPort {
    /// Takes hold of the chip without stopping or resetting it.
    pub(super) fn of(mut probe: Probe) -> Result<Self, Error> {
        let silent = |error: String| {
            Error::Work(format!(
                "the chip does not answer its probe ({error}): has the board its supply, and are \
                 both jumpers of CN2 in place?"
            ))
        };
        let no_answer = |error: probe_rs::Error| silent(chain(&error));
        probe
            .select_protocol(WireProtocol::Swd)
            .map_err(|error| silent(chain(&error)))?;
        probe.attach_to_unspecified().map_err(no_answer)?;
        let interface = probe.try_into_arm_debug_interface(DefaultArmSequence::create());
        let mut interface = interface.map_err(|(_, error)| silent(chain(&error)))?;
        let port = interface.select_debug_port(DpAddress::Default);
        port.map_err(|error| silent(chain(&error)))?;
        Ok(Self { interface })
    }

    /// The identity of the chip, where such a board's has it.
    pub(super) fn chip_id(&mut self, board: BoardName) -> Result<u16, Error> {
        let mut bytes = [0; 4];
        self.read(board.chip_id_at(), &mut bytes)?;
        Ok(u32::from_le_bytes(bytes) as u16 & 0xFFF)
    }

    /// Fails unless it is the chip of that board.
    pub(super) fn check(&mut self, board: BoardName) -> Result<(), Error> {
        let found = self.chip_id(board)?;
        if found == board.chip_id() {
            return Ok(());
        }
        Err(Error::Work(format!(
            "the chip is of identity {found:#05x}, that of a {} is {:#05x}; --board says which \
             board it is",
            board.name(),
            board.chip_id()
        )))
    }

    /// Resets the chip, as the reset button does.
    pub(super) fn reset(&mut self) -> Result<(), Error> {
        self.write(RESET_CONTROL, &RESET.to_le_bytes())
    }

    fn with<T>(
        &mut self,
        work: impl FnOnce(
            &mut dyn probe_rs::architecture::arm::memory::ArmMemoryInterface,
        ) -> Result<T, ArmError>,
    ) -> Result<T, Error> {
        // All three chips have one memory port, the first (AHB-AP).
        let first = FullyQualifiedApAddress::v1_with_default_dp(0);
        let memory = self.interface.memory_interface(&first);
        memory.and_then(|mut memory| work(&mut *memory)).map_err(|error| {
            Error::Work(format!(
                "the probe does not answer any more ({}): is it unplugged, or the board without \
                 supply?",
                chain(&error)
            ))
        })
    }
}

impl Ram for MemoryPort {
    type Fault = Error;

    fn read(&mut self, at: u32, into: &mut [u8]) -> Result<(), Error> {
        self.with(|memory| memory.read(at.into(), into))
    }

    fn write(&mut self, at: u32, bytes: &[u8]) -> Result<(), Error> {
        self.with(|memory| {
            memory.write(at.into(), bytes)?;
            memory.flush()
        })
    }
}

/// An error with all its causes, in a line.
pub(super) fn chain(error: &dyn std::error::Error) -> String {
    let causes = std::iter::successors(Some(error), |error| error.source());
    let causes: Vec<_> = causes.map(ToString::to_string).collect();
    causes.join(": ")
}
