//! What a debug probe must know of each board's chip.

use firmware::boards::{BoardFacts, NUCLEO_F103RB, NUCLEO_F446RE, NUCLEO_G071RB};

use super::program::BoardName;

impl BoardName {
    /// Its name, as options have it.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::NucleoF446re => "nucleo-f446re",
            Self::NucleoF103rb => "nucleo-f103rb",
            Self::NucleoG071rb => "nucleo-g071rb",
        }
    }

    /// What is known of it.
    pub(crate) const fn facts(self) -> &'static BoardFacts {
        match self {
            Self::NucleoF446re => &NUCLEO_F446RE,
            Self::NucleoF103rb => &NUCLEO_F103RB,
            Self::NucleoG071rb => &NUCLEO_G071RB,
        }
    }
}

#[cfg_attr(
    not(feature = "probe"),
    allow(dead_code, reason = "of the programs that have probes")
)]
impl BoardName {
    /// Every board.
    #[cfg(test)]
    pub(crate) const ALL: [Self; 3] = [Self::NucleoF446re, Self::NucleoF103rb, Self::NucleoG071rb];

    /// What probe-rs calls its chip.
    pub(crate) const fn chip(self) -> &'static str {
        match self {
            Self::NucleoF446re => "STM32F446RETx",
            Self::NucleoF103rb => "STM32F103RBTx",
            Self::NucleoG071rb => "STM32G071RBTx",
        }
    }

    /// The identity of its chip (RM0390, RM0008 and RM0444, "Debug support", "MCU device ID
    /// code": DEV_ID).
    pub(crate) const fn chip_id(self) -> u16 {
        match self {
            Self::NucleoF446re => 0x421,
            Self::NucleoF103rb => 0x410,
            Self::NucleoG071rb => 0x460,
        }
    }

    /// Where it stands: the first register of DBGMCU, or of DBG.
    pub(crate) const fn chip_id_at(self) -> u32 {
        match self {
            Self::NucleoF446re | Self::NucleoF103rb => 0xE004_2000,
            Self::NucleoG071rb => 0x4001_5800,
        }
    }

    /// Where its RAM begins, and how many bytes it has.
    pub(crate) const fn ram(self) -> (u32, usize) {
        let kib = match self {
            Self::NucleoF446re => 128,
            Self::NucleoF103rb => 20,
            Self::NucleoG071rb => 36,
        };
        (0x2000_0000, kib * 1024)
    }
}

#[cfg(all(test, feature = "probe"))]
mod tests {
    use probe_rs::config::{MemoryRegion, Registry};

    use super::BoardName;

    #[test]
    fn chips_and_their_ram_are_those_that_probe_rs_knows() {
        let registry = Registry::from_builtin_families();
        for board in BoardName::ALL {
            let target = registry.get_target_by_name(board.chip()).unwrap();
            let mut ram = target.memory_map.iter().filter_map(|region| match region {
                MemoryRegion::Ram(ram) => Some(ram.range.clone()),
                _ => None,
            });
            let (at, length) = board.ram();
            let found = ram.next().unwrap();
            assert_eq!(found.start, u64::from(at));
            // What follows directly is of the same RAM.
            let end = ram.fold(
                found.end,
                |end, next| {
                    if next.start == end { next.end } else { end }
                },
            );
            assert_eq!(end - found.start, length as u64, "{}", board.name());
        }
    }
}
