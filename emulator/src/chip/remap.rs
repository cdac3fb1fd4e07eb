//! AFIO: which pins the debugger keeps (STM32F1; RM0008, chapter 9). Another place for a
//! peripheral's pins is not modelled.

use super::fields::{Field, field};

const MAPR: u32 = 0x04;
/// What of the debugger's pins is given up.
const SWJ_CFG: u32 = 7 << 24;

pub(super) const FIELDS: [Field; 1] = [field("MAPR", MAPR, "SWJ_CFG", SWJ_CFG)];

/// JTAG, but not the two other wires; or everything.
const JTAG_GIVEN_UP: [u32; 2] = [2 << 24, 4 << 24];

/// JTAG's pins but for the two other wires: PA15, PB3 and PB4, by port and number.
const JTAG: [(usize, u32); 3] = [(0, 15), (1, 3), (1, 4)];

#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Remap {
    mapr: u32,
}

impl Remap {
    pub(super) fn keeps(self, port: usize, pin: u32) -> bool {
        JTAG.contains(&(port, pin)) && !JTAG_GIVEN_UP.contains(&self.mapr)
    }

    /// What JTAG gives up cannot be read back.
    pub(super) const fn read(offset: u32) -> Option<u32> {
        match offset {
            MAPR => Some(0),
            _ => None,
        }
    }

    pub(super) const fn write(&mut self, offset: u32, value: u32) -> bool {
        if offset != MAPR || value & !SWJ_CFG != 0 {
            return false;
        }
        self.mapr = value;
        true
    }
}
