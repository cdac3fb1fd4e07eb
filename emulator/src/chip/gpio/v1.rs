//! A port with four bits a pin, MODE and CNF, in two registers (STM32F1; RM0008,
//! chapter 9).

use super::{Common, Role};
use crate::chip::fields::{Field, field};

const CRL: u32 = 0x00;
const CRH: u32 = 0x04;
const IDR: u32 = 0x08;
const ODR: u32 = 0x0C;
const BSRR: u32 = 0x10;
const BRR: u32 = 0x14;

/// Those of pin 1, and of pin 9 where it is in another register.
pub(super) const FIELDS: [Field; 8] = [
    field("CRL", CRL, "MODE1", 3 << 4),
    field("CRL", CRL, "CNF1", 3 << 6),
    field("CRH", CRH, "MODE9", 3 << 4),
    field("CRH", CRH, "CNF9", 3 << 6),
    field("IDR", IDR, "IDR1", 1 << 1),
    field("ODR", ODR, "ODR1", 1 << 1),
    field("BSRR", BSRR, "BR1", 1 << 17),
    field("BRR", BRR, "BR1", 1 << 1),
];

pub(super) const fn common(offset: u32) -> Option<Common> {
    match offset {
        IDR => Some(Common::Idr),
        ODR => Some(Common::Odr),
        BSRR => Some(Common::Bsrr),
        BRR => Some(Common::Brr),
        _ => None,
    }
}

/// CRL and CRH.
#[derive(Debug, Clone)]
pub(super) struct TwoRegisters([u32; 2]);

impl Default for TwoRegisters {
    /// Floating inputs.
    fn default() -> Self {
        Self([0x4444_4444; 2])
    }
}

impl TwoRegisters {
    const fn of(&self, pin: u32) -> (u32, u32) {
        let bits = self.0[(pin / 8) as usize] >> (4 * (pin % 8));
        (bits & 3, (bits >> 2) & 3)
    }

    pub(super) const fn role(&self, pin: u32, high: bool) -> Role {
        match self.of(pin) {
            (0, 0) => Role::Analogue,
            (0, _) => Role::Input,
            (_, 0 | 1) => Role::Output(high),
            _ => Role::Alternate(0),
        }
    }

    pub(super) const fn is_open_drain(&self, pin: u32) -> bool {
        let (mode, cnf) = self.of(pin);
        mode != 0 && cnf & 1 != 0
    }

    pub(super) const fn read(&self, offset: u32) -> Option<u32> {
        match offset {
            CRL => Some(self.0[0]),
            CRH => Some(self.0[1]),
            _ => None,
        }
    }

    pub(super) const fn write(&mut self, offset: u32, value: u32) -> bool {
        match offset {
            CRL => self.0[0] = value,
            CRH => self.0[1] = value,
            _ => return false,
        }
        true
    }
}
