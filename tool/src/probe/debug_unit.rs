//! The debug unit of a board's chip: which chip it is, and what stands still with its core.

use rtt::Ram;

use crate::source::BoardName;

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

pub(super) fn identity<R: Ram>(chip: &mut R, board: BoardName) -> Result<u16, R::Fault> {
    if board == BoardName::NucleoG071rb {
        set(chip, G071_CLOCKS, G071_DEBUG)?;
    }
    Ok(word(chip, begin(board))? as u16 & 0xFFF)
}

/// Has motors and watchdog stop with the core, whoever halts it.
pub(super) fn freeze<R: Ram>(chip: &mut R, board: BoardName) -> Result<(), R::Fault> {
    let mut freezes = freezes(board).iter();
    freezes.try_for_each(|(offset, bits)| set(chip, begin(board) + offset, *bits))
}

pub(super) fn word<R: Ram>(chip: &mut R, at: u32) -> Result<u32, R::Fault> {
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

    use rtt::Ram;

    use super::{G071_CLOCKS, G071_DEBUG, freeze, identity};
    use crate::source::BoardName;

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
            assert_eq!(
                identity(&mut chip, board),
                Ok(id as u16 & 0xFFF),
                "{board:?}"
            );
        }
    }

    #[test]
    fn clocks_that_run_go_on_and_motors_stop_with_the_core() {
        let mut chip = Chip(BTreeMap::from([(G071_CLOCKS, 1 << 1)]));
        let board = BoardName::NucleoG071rb;
        assert!(identity(&mut chip, board).is_ok() && freeze(&mut chip, board).is_ok());
        assert_eq!(chip.0[&G071_CLOCKS], G071_DEBUG | 1 << 1);
        assert_eq!(
            (chip.0[&0x4001_5808], chip.0[&0x4001_580C]),
            (1 << 12, 1 << 11)
        );
    }
}
