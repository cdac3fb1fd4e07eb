//! A port with a mode, a type, a speed, a pull and a function register (STM32F4, STM32G0;
//! RM0390, chapter 7; RM0444, chapter 7).

use super::{Common, Role};
use crate::chip::fields::{Field, field};

const MODER: u32 = 0x00;
const OTYPER: u32 = 0x04;
const OSPEEDR: u32 = 0x08;
const PUPDR: u32 = 0x0C;
const AFRL: u32 = 0x20;
const AFRH: u32 = 0x24;
const IDR: u32 = 0x10;
const ODR: u32 = 0x14;
const BSRR: u32 = 0x18;

/// Those of pin 1, and of pin 9 where it is in another register.
pub(super) const FIELDS: [Field; 9] = [
    field("MODER", MODER, "MODER1", 3 << 2),
    field("OTYPER", OTYPER, "OT1", 1 << 1),
    field("OSPEEDR", OSPEEDR, "OSPEEDR1", 3 << 2),
    field("PUPDR", PUPDR, "PUPDR1", 3 << 2),
    field("AFRL", AFRL, "AFR1", 15 << 4),
    field("AFRH", AFRH, "AFR9", 15 << 4),
    field("IDR", IDR, "IDR1", 1 << 1),
    field("ODR", ODR, "ODR1", 1 << 1),
    field("BSRR", BSRR, "BR1", 1 << 17),
];

/// BRR, which not all of these chips have, is not used.
pub(super) const fn common(offset: u32) -> Option<Common> {
    match offset {
        IDR => Some(Common::Idr),
        ODR => Some(Common::Odr),
        BSRR => Some(Common::Bsrr),
        _ => None,
    }
}

/// Registers that keep what is written.
const KEPT: [u32; 6] = [MODER, OTYPER, OSPEEDR, PUPDR, AFRL, AFRH];

#[derive(Debug, Clone)]
pub(super) struct Modes {
    /// By their offsets, a word each.
    registers: [u32; 10],
}

impl Modes {
    pub(super) const fn new([moder, ospeedr, pupdr]: [u32; 3]) -> Self {
        Self {
            registers: [moder, 0, ospeedr, pupdr, 0, 0, 0, 0, 0, 0],
        }
    }

    const fn get(&self, offset: u32) -> u32 {
        self.registers[offset as usize / 4]
    }

    pub(super) const fn role(&self, pin: u32, high: bool) -> Role {
        match (self.get(MODER) >> (2 * pin)) & 3 {
            0 => Role::Input,
            1 => Role::Output(high),
            2 => {
                let functions = self.get(if pin < 8 { AFRL } else { AFRH });
                Role::Alternate((functions >> (4 * (pin % 8))) & 15)
            }
            _ => Role::Analogue,
        }
    }

    pub(super) const fn is_open_drain(&self, pin: u32) -> bool {
        self.get(OTYPER) & (1 << pin) != 0
    }

    pub(super) fn read(&self, offset: u32) -> Option<u32> {
        KEPT.contains(&offset).then(|| self.get(offset))
    }

    pub(super) fn write(&mut self, offset: u32, value: u32) -> bool {
        let is_known = KEPT.contains(&offset);
        if is_known {
            let value = if offset == OTYPER {
                value & 0xFFFF
            } else {
                value
            };
            self.registers[offset as usize / 4] = value;
        }
        is_known
    }
}
