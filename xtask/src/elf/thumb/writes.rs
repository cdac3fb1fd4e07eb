//! Which registers an instruction may write: more than it does, where that is shorter to say.

use super::Instruction;

/// Those that a call leaves with any value, a bit each: r0 to r3 and r12.
const BY_A_CALL: u16 = 0x100F;

impl Instruction {
    /// The register that it calls or goes by (BLX, BX).
    pub(super) fn goes_by(self) -> Option<u16> {
        let goes = self.second.is_none() && self.first & 0xFF07 == 0x4700;
        goes.then_some(self.first >> 3 & 0xF)
    }

    /// The register that it moves to this one (MOV).
    pub(super) fn is_move_to(self, register: u16) -> Option<u16> {
        let is_move = self.second.is_none() && self.first >> 8 == 0x46;
        let to = self.first >> 4 & 8 | self.first & 7;
        (is_move && to == register).then_some(self.first >> 3 & 0xF)
    }

    /// Whether it takes the address of what follows to this register (ADR.W).
    pub(super) fn is_address_to(self, register: u16) -> bool {
        let to = |second: u16| second >> 8 & 0xF == register;
        self.first & 0xFBFF == 0xF20F && self.second.is_some_and(to)
    }

    pub(super) fn is_load_of(self, register: u16) -> bool {
        match self.second {
            Some(second) => matches!(self.first, 0xF85F | 0xF8DF) && second >> 12 == register,
            None => self.first >> 11 == 0b01001 && self.first >> 8 & 7 == register,
        }
    }

    pub(super) fn may_write(self, register: u16) -> bool {
        let writes = match self.second {
            Some(second) => wide(self.first, second),
            None => narrow(self.first),
        };
        writes >> register & 1 == 1
    }
}

/// A bit for each register that an instruction of two bytes may write.
const fn narrow(code: u16) -> u16 {
    let high = 1 << (code >> 8 & 7);
    match code {
        // MOV, CMP, ADD and SUB with a constant of a byte; LDR relative to PC and SP, ADR; STM.
        0x2000..=0x3FFF | 0x4800..=0x4FFF | 0x9800..=0xAFFF | 0xC000..=0xC7FF => high,
        // ADD and MOV of any register.
        0x4400..=0x46FF => 1 << (code >> 4 & 8 | code & 7),
        // BLX.
        0x4780..=0x47FF => BY_A_CALL,
        // POP; LDM, and its base.
        0xBC00..=0xBDFF => code & 0xFF,
        0xC800..=0xCFFF => code & 0xFF | high,
        // BX; stores; PUSH, ADD SP, CBZ and CBNZ, IT and hints, branches.
        0x4700..=0x477F
        | 0x5000..=0x55FF
        | 0x6000..=0x67FF
        | 0x7000..=0x77FF
        | 0x8000..=0x87FF
        | 0x9000..=0x97FF
        | 0xB000..=0xB1FF
        | 0xB300..=0xB5FF
        | 0xB900..=0xB9FF
        | 0xBB00.. => 0,
        _ => 1 << (code & 7),
    }
}

/// The same of four bytes.
const fn wide(first: u16, second: u16) -> u16 {
    let middle = 1 << (second >> 8 & 0xF);
    if first >> 11 == 0b11110 {
        return match second >> 12 {
            // A constant, or MRS.
            0..8 => middle,
            _ if first == 0xF3EF => middle,
            // BL; other branches.
            13 | 15 => BY_A_CALL,
            _ => 0,
        };
    }
    // LDM and POP.
    if matches!(first & 0xFFD0, 0xE890 | 0xE910) {
        return second | 1 << (first & 0xF);
    }
    // Of one register, and its base.
    if first >> 9 == 0b111_1100 {
        return 1 << (second >> 12) | 1 << (first & 0xF);
    }
    // Destinations, and a base that is written back.
    1 << (second >> 12) | middle | 1 << (first & 0xF)
}
