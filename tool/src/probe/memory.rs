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

use super::debug_unit;
use crate::source::{Board, BoardName};

/// The register that resets the chip (AIRCR), and what asks for it (Armv7-M Architecture
/// Reference Manual, "Application Interrupt and Reset Control Register"; Armv6-M has the same).
const RESET_CONTROL: u32 = 0xE000_ED0C;
const RESET: u32 = 0x05FA_0004;

/// Where the RAM of a board's chip begins, and how many bytes it has.
pub(super) const fn ram(board: BoardName) -> (u32, usize) {
    let kib = match board {
        BoardName::NucleoF446re => 128,
        BoardName::NucleoF103rb => 20,
        BoardName::NucleoG071rb => 36,
    };
    (0x2000_0000, kib * 1024)
}

pub(super) struct MemoryPort {
    interface: Box<dyn ArmDebugInterface + 'static>,
}

impl MemoryPort {
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

    pub(super) fn chip_id(&mut self, board: BoardName) -> Result<u16, Error> {
        debug_unit::identity(self, board)
    }

    /// Sees that it is the chip of this board, and has its motors stop with its core.
    pub(super) fn check(&mut self, board: BoardName) -> Result<(), Error> {
        let found = self.chip_id(board)?;
        let Board { name, chip_id, .. } = board.board();
        if found == chip_id {
            return debug_unit::freeze(self, board);
        }
        Err(Error::Work(format!(
            "the chip is of identity {found:#05x}, that of a {name} is {chip_id:#05x}; --board \
             says which board it is"
        )))
    }

    pub(super) fn word(&mut self, at: u32) -> Result<u32, Error> {
        debug_unit::word(self, at)
    }

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

pub(super) fn chain(error: &dyn std::error::Error) -> String {
    let causes = std::iter::successors(Some(error), |error| error.source());
    let causes: Vec<_> = causes.map(ToString::to_string).collect();
    causes.join(": ")
}

#[cfg(test)]
mod tests {
    use clap::ValueEnum;
    use probe_rs::config::{MemoryRegion, Registry};

    use super::{BoardName, ram};

    #[test]
    fn chips_and_their_ram_are_those_that_probe_rs_knows() {
        let registry = Registry::from_builtin_families();
        for name in BoardName::value_variants() {
            let chip = name.board().chip;
            let target = registry.get_target_by_name(chip).unwrap();
            let mut regions = target.memory_map.iter().filter_map(|region| match region {
                MemoryRegion::Ram(ram) => Some(ram.range.clone()),
                _ => None,
            });
            let (at, length) = ram(*name);
            let found = regions.next().unwrap();
            assert_eq!(found.start, u64::from(at));
            // What follows directly is of the same RAM.
            let end = regions.fold(found.end, |end, next| match next.start {
                start if start == end => next.end,
                _ => end,
            });
            assert_eq!(end - found.start, length as u64, "{chip}");
        }
    }
}
