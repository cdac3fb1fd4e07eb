//! The two kinds of ports. V1: four bits a pin, MODE and CNF, in two registers; STM32F1; RM0008,
//! chapter 9. V2: a mode, a type, a speed, a pull and a function register; STM32F4, STM32G0;
//! RM0390, chapter 7; RM0444, chapter 7.

use super::{Registers, Role};
use crate::chip::fields::{Field, field};

#[derive(Debug)]
pub(in crate::chip) struct Layout {
    /// Those of pin 1, and of pin 9 where it is in another register.
    pub(in crate::chip) fields: &'static [Field],
    /// The registers that configure, and the bits of each that keep what is written.
    pub(super) kept: &'static [(u32, u32)],
    pub(super) idr: u32,
    pub(super) odr: u32,
    pub(super) bsrr: u32,
    pub(super) brr: Option<u32>,
    /// Of a pin, with its level if it is an output.
    pub(super) role: fn(&Registers, u32, bool) -> Role,
    pub(super) is_open_drain: fn(&Registers, u32) -> bool,
    /// Whether an ordinary input is a peripheral's, too.
    pub(super) feeds_all: bool,
}

pub(super) static V1: Layout = {
    const CRL: u32 = 0x00;
    const CRH: u32 = 0x04;
    const IDR: u32 = 0x08;
    const ODR: u32 = 0x0C;
    const BSRR: u32 = 0x10;
    const BRR: u32 = 0x14;

    const fn of(registers: &Registers, pin: u32) -> (u32, u32) {
        let bits = registers[(pin / 8) as usize] >> (4 * (pin % 8));
        (bits & 3, (bits >> 2) & 3)
    }

    Layout {
        fields: &[
            field("CRL", CRL, "MODE1", 3 << 4),
            field("CRL", CRL, "CNF1", 3 << 6),
            field("CRH", CRH, "MODE9", 3 << 4),
            field("CRH", CRH, "CNF9", 3 << 6),
            field("IDR", IDR, "IDR1", 1 << 1),
            field("ODR", ODR, "ODR1", 1 << 1),
            field("BSRR", BSRR, "BR1", 1 << 17),
            field("BRR", BRR, "BR1", 1 << 1),
        ],
        kept: &[(CRL, u32::MAX), (CRH, u32::MAX)],
        idr: IDR,
        odr: ODR,
        bsrr: BSRR,
        brr: Some(BRR),
        role: |registers, pin, high| match of(registers, pin) {
            (0, 0) => Role::Analogue,
            (0, _) => Role::Input,
            (_, 0 | 1) => Role::Output(high),
            _ => Role::Alternate(0),
        },
        is_open_drain: |registers, pin| {
            let (mode, cnf) = of(registers, pin);
            mode != 0 && cnf & 1 != 0
        },
        feeds_all: true,
    }
};

pub(super) static V2: Layout = {
    const MODER: u32 = 0x00;
    const OTYPER: u32 = 0x04;
    const OSPEEDR: u32 = 0x08;
    const PUPDR: u32 = 0x0C;
    const IDR: u32 = 0x10;
    const ODR: u32 = 0x14;
    const BSRR: u32 = 0x18;
    const AFRL: u32 = 0x20;
    const AFRH: u32 = 0x24;

    Layout {
        fields: &[
            field("MODER", MODER, "MODER1", 3 << 2),
            field("OTYPER", OTYPER, "OT1", 1 << 1),
            field("OSPEEDR", OSPEEDR, "OSPEEDR1", 3 << 2),
            field("PUPDR", PUPDR, "PUPDR1", 3 << 2),
            field("AFRL", AFRL, "AFR1", 15 << 4),
            field("AFRH", AFRH, "AFR9", 15 << 4),
            field("IDR", IDR, "IDR1", 1 << 1),
            field("ODR", ODR, "ODR1", 1 << 1),
            field("BSRR", BSRR, "BR1", 1 << 17),
        ],
        kept: &[
            (MODER, u32::MAX),
            (OTYPER, 0xFFFF),
            (OSPEEDR, u32::MAX),
            (PUPDR, u32::MAX),
            (AFRL, u32::MAX),
            (AFRH, u32::MAX),
        ],
        idr: IDR,
        odr: ODR,
        bsrr: BSRR,
        // Not all of these chips have it, and it is not used.
        brr: None,
        role: |registers, pin, high| match (registers[MODER as usize / 4] >> (2 * pin)) & 3 {
            0 => Role::Input,
            1 => Role::Output(high),
            2 => {
                let functions = registers[if pin < 8 { AFRL } else { AFRH } as usize / 4];
                Role::Alternate((functions >> (4 * (pin % 8))) & 15)
            }
            _ => Role::Analogue,
        },
        is_open_drain: |registers, pin| registers[OTYPER as usize / 4] & (1 << pin) != 0,
        feeds_all: false,
    }
};
