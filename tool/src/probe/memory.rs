//! The chip's memory, read and written while the core runs; by it the debug unit, which says which
//! chip it is, and what stands still with its core.
//!
//! probe-rs's own session halts the core as it attaches and as it ends, to clear breakpoints. A
//! motor would be driven on meanwhile. To talk with a module its memory port is enough.

use host_sim::Error;
use probe_rs::architecture::arm::dp::DpAddress;
use probe_rs::architecture::arm::sequences::DefaultArmSequence;
use probe_rs::architecture::arm::{ArmDebugInterface, ArmError, FullyQualifiedApAddress};
use probe_rs::probe::{Probe, WireProtocol};
use rtt::Ram;

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
        identity(self, board)
    }

    /// Sees that it is the chip of this board, and has its motors stop with its core.
    pub(super) fn check(&mut self, board: BoardName) -> Result<(), Error> {
        let found = self.chip_id(board)?;
        let Board { name, chip_id, .. } = board.board();
        if found == chip_id {
            return freeze(self, board);
        }
        Err(Error::Work(format!(
            "the chip is of identity {found:#05x}, that of a {name} is {chip_id:#05x}; --board \
             says which board it is"
        )))
    }

    pub(super) fn word(&mut self, at: u32) -> Result<u32, Error> {
        word(self, at)
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

/// In the G071, whose debug unit has no clock after a power-up: the register of clocks that has its
/// bit, and the bit (RM0444, RCC_APBENR1: DBGEN).
const G071_CLOCKS: u32 = 0x4002_103C;
const G071_DEBUG: u32 = 1 << 27;

/// Where the debug unit begins, with the chip's identity (DBGMCU_IDCODE; DBG_IDCODE).
const fn begin(board: BoardName) -> u32 {
    match board {
        BoardName::NucleoF446re | BoardName::NucleoF103rb => 0xE004_2000,
        BoardName::NucleoG071rb => 0x4001_5800,
    }
}

/// Its registers by which the motors' timer, TIM1, and the watchdog stop with the core, and the log is
/// read in sleep; and the bits, which the board's program sets too (RM0390, RM0008: DBGMCU_CR and
/// freeze registers; RM0444: DBG_APB_FZ1, DBG_APB_FZ2).
const fn freezes(board: BoardName) -> &'static [(u32, u32)] {
    match board {
        BoardName::NucleoF446re => &[(0x04, 1), (0x08, 1 << 12), (0x0C, 1)],
        BoardName::NucleoF103rb => &[(0x04, 1 | 1 << 8 | 1 << 10)],
        BoardName::NucleoG071rb => &[(0x08, 1 << 12), (0x0C, 1 << 11)],
    }
}

fn identity<R: Ram>(chip: &mut R, board: BoardName) -> Result<u16, R::Fault> {
    if board == BoardName::NucleoG071rb {
        set(chip, G071_CLOCKS, G071_DEBUG)?;
    }
    Ok(word(chip, begin(board))? as u16 & 0xFFF)
}

/// Has motors and watchdog stop with the core, whoever halts it.
fn freeze<R: Ram>(chip: &mut R, board: BoardName) -> Result<(), R::Fault> {
    let mut freezes = freezes(board).iter();
    freezes.try_for_each(|(offset, bits)| set(chip, begin(board) + offset, *bits))
}

fn word<R: Ram>(chip: &mut R, at: u32) -> Result<u32, R::Fault> {
    let mut bytes = [0; 4];
    chip.read(at, &mut bytes)?;
    Ok(u32::from_le_bytes(bytes))
}

fn set<R: Ram>(chip: &mut R, at: u32, bits: u32) -> Result<(), R::Fault> {
    let value = word(chip, at)? | bits;
    chip.write(at, &value.to_le_bytes())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::convert::Infallible;

    use clap::ValueEnum;
    use probe_rs::config::{MemoryRegion, Registry};
    use rtt::Ram;

    use super::{BoardName, G071_CLOCKS, G071_DEBUG, freeze, identity, ram};

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

    /// The words of a chip. Those of the debug unit read as zero while it has no clock.
    #[derive(Default)]
    struct Chip(BTreeMap<u32, u32>);

    impl Chip {
        fn is_clocked(&self, at: u32) -> bool {
            let clocks = self.0.get(&G071_CLOCKS).copied().unwrap_or_default();
            !(0x4001_5800..0x4001_5C00).contains(&at) || clocks & G071_DEBUG != 0
        }
    }

    impl Ram for Chip {
        type Fault = Infallible;

        fn read(&mut self, at: u32, into: &mut [u8]) -> Result<(), Infallible> {
            let word = self.0.get(&at).copied().filter(|_| self.is_clocked(at));
            into.copy_from_slice(&word.unwrap_or_default().to_le_bytes());
            Ok(())
        }

        fn write(&mut self, at: u32, bytes: &[u8]) -> Result<(), Infallible> {
            if self.is_clocked(at) {
                let word = <[u8; 4]>::try_from(bytes).map(u32::from_le_bytes);
                self.0.insert(at, word.expect("a word"));
            }
            Ok(())
        }
    }

    #[test]
    fn a_chip_as_it_came_from_the_factory_has_its_identity() {
        for (board, at, id) in [
            (BoardName::NucleoF446re, 0xE004_2000, 0x1000_0421),
            (BoardName::NucleoF103rb, 0xE004_2000, 0x2003_6410),
            (BoardName::NucleoG071rb, 0x4001_5800, 0x1000_0460),
        ] {
            let mut chip = Chip(BTreeMap::from([(at, id)]));
            let found = identity(&mut chip, board);
            assert_eq!(found, Ok(id as u16 & 0xFFF), "{board:?}");
        }
    }

    #[test]
    fn clocks_that_run_go_on_and_motors_stop_with_the_core() {
        let mut chip = Chip(BTreeMap::from([(G071_CLOCKS, 1 << 1)]));
        let board = BoardName::NucleoG071rb;
        assert!(identity(&mut chip, board).is_ok() && freeze(&mut chip, board).is_ok());
        assert_eq!(chip.0[&G071_CLOCKS], G071_DEBUG | 1 << 1);
        let freezes = [0x4001_5808, 0x4001_580C].map(|at| chip.0[&at]);
        assert_eq!(freezes, [1 << 12, 1 << 11]);
    }
}
