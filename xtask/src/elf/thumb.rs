//! As much of Thumb code as stack and calls need (Arm v7-M and v6-M Architecture
//! Reference Manuals, chapters A5 to A7): what moves the stack pointer down, and what
//! goes somewhere else. What cannot be followed is [`Step::Open`].

mod jump;
#[cfg(test)]
mod tests;
mod writes;

use std::collections::BTreeSet;

use jump::Jump;

/// What an instruction does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Step {
    Push(u64),
    Go(u64),
    /// Goes wherever a register or a word in memory says, or moves the stack by one.
    Open,
    Trap,
}

/// The steps of a function whose code `body` begins at address `begin`, in
/// order of address; `is_instruction` tells instructions from constants.
pub(super) fn steps(body: &[u8], begin: u64, is_instruction: impl Fn(u64) -> bool) -> Vec<Step> {
    let instructions = instructions(body, begin, &is_instruction);
    let place = begin..begin + body.len() as u64;
    let literals = instructions.iter().filter_map(|code| code.literal());
    let literals: BTreeSet<u64> = literals.collect();
    let is_literal = |at: u64| literals.contains(&(at & !3));
    let mut steps = Vec::new();
    for (number, code) in instructions.iter().enumerate() {
        let before = number.checked_sub(1).map(|before| instructions[before]);
        let frame = before.and_then(|before| code.frame(before, |at| word(body, begin, at)));
        let called = || called(&instructions[..number], *code, |at| word(body, begin, at));
        let step = frame.map(Step::Push).or_else(|| called().map(Step::Go));
        let before = &instructions[number.saturating_sub(4)..number];
        let jump = code.jump(before);
        steps.extend(step.or_else(|| code.step().filter(|_| jump.is_none())));
        if let Some(jump) = jump {
            let table = jump::table(body, &place, code.end(), &is_instruction, is_literal);
            let stays = jump.stays(table, code.address, |to| place.contains(&to));
            steps.extend((!stays).then_some(Step::Open));
        }
    }
    steps
}

/// The function that `code` calls by a register that holds a constant, which the last
/// instruction to write it has loaded, or moved from another: how several calls of one function
/// take less room. `before` is the code before it.
fn called(
    mut before: &[Instruction],
    code: Instruction,
    word: impl Fn(u64) -> Option<i32>,
) -> Option<u64> {
    let mut register = code.goes_by()?;
    loop {
        let last = before.iter().rposition(|code| code.may_write(register))?;
        let writer = before[last];
        if let Some(from) = writer.is_move_to(register) {
            (before, register) = (&before[..last], from);
            continue;
        }
        let address = word(writer.literal().filter(|_| writer.is_load_of(register))?)?;
        let address = u64::from(address.cast_unsigned());
        return (address & 1 == 1).then_some(address & !1);
    }
}

fn word(body: &[u8], begin: u64, address: u64) -> Option<i32> {
    let at = usize::try_from(address.checked_sub(begin)?).ok()?;
    let bytes = body.get(at..)?.first_chunk()?;
    Some(i32::from_le_bytes(*bytes))
}

#[derive(Debug, Clone, Copy)]
struct Instruction {
    address: u64,
    first: u16,
    /// Of those of four bytes.
    second: Option<u16>,
}

fn instructions(body: &[u8], begin: u64, is_instruction: impl Fn(u64) -> bool) -> Vec<Instruction> {
    let half = |address: u64| -> Option<u16> {
        let at = (address - begin) as usize;
        let bytes = body.get(at..at + 2)?;
        Some(u16::from_le_bytes([bytes[0], bytes[1]]))
    };
    let mut found = Vec::new();
    let mut address = begin;
    while let Some(first) = half(address) {
        if !is_instruction(address) {
            address += 2;
            continue;
        }
        // Three patterns of the top five bits begin an instruction of four bytes.
        let is_wide = first >> 11 >= 0b11101;
        let second = half(address + 2).filter(|_| is_wide);
        let code = Instruction {
            address,
            first,
            second,
        };
        address = code.end();
        found.push(code);
    }
    found
}

impl Instruction {
    fn end(self) -> u64 {
        self.address + if self.second.is_some() { 4 } else { 2 }
    }

    fn step(self) -> Option<Step> {
        match self.second {
            Some(second) => wide(self.first, second, self.address),
            None => narrow(self.first, self.address),
        }
    }

    /// The bytes of stack that it takes by ADD SP, register, where `before` loads that register
    /// with a constant below zero: how a core without SUBW takes a large frame.
    fn frame(self, before: Self, word: impl Fn(u64) -> Option<i32>) -> Option<u64> {
        let is_add = self.second.is_none() && self.first & 0xFF87 == 0x4485;
        let is_load = before.second.is_none() && before.first >> 11 == 0b01001;
        let same = self.first >> 3 & 0xF == before.first >> 8 & 7;
        if !(is_add && is_load && same) {
            return None;
        }
        let moved = word(before.literal()?)?;
        (moved < 0).then(|| moved.unsigned_abs().into())
    }

    /// The constant that it loads from beside the code: LDR and VLDR relative to PC.
    fn literal(self) -> Option<u64> {
        let from = (self.address + 4) & !3;
        let first = self.first;
        let Some(second) = self.second.map(u64::from) else {
            return (first >> 11 == 0b01001).then(|| from + 4 * u64::from(first & 0xFF));
        };
        let (is_up, offset) = match first {
            0xF85F | 0xF8DF => (first & 0x80 != 0, second & 0xFFF),
            _ if first & 0xFF3F == 0xED1F => (first & 0x80 != 0, 4 * (second & 0xFF)),
            _ => return None,
        };
        Some(if is_up { from + offset } else { from - offset })
    }

    /// If it jumps by a table: `before` is the code before it.
    fn jump(self, before: &[Self]) -> Option<Jump> {
        if let Some(second) = self.second {
            // A table that stands behind constants has its address taken just before.
            let base = self.first & 0xF;
            let is_known = base == 15 || before.last()?.is_address_to(base);
            return Jump::wide(self.first, second).filter(|_| is_known);
        }
        // MOV PC, register, to whose address the choice is added.
        let register = self.first >> 3 & 0xF;
        let is_move = self.first & 0xFF87 == 0x4687;
        if is_move && before.iter().any(|code| code.is_address_to(register)) {
            return Some(Jump::Branches);
        }
        let loads = before.iter().nth_back(1);
        Jump::narrow(self.first, loads.map_or(0, |loads| loads.first))
    }
}

/// The address that a branch goes to: four beyond the instruction, plus `offset`.
fn target(address: u64, offset: i64) -> Step {
    Step::Go(address.wrapping_add(4).wrapping_add_signed(offset))
}

/// `value`, whose topmost bit is number `bits` − 1, with its sign.
fn signed(value: u32, bits: u32) -> i64 {
    let shift = 32 - bits;
    i64::from((value << shift).cast_signed() >> shift)
}

fn narrow(code: u16, address: u64) -> Option<Step> {
    let word = u32::from(code);
    match code {
        // PUSH: a register a bit, and LR.
        0xB400..=0xB5FF => Some(Step::Push(4 * u64::from((word & 0x1FF).count_ones()))),
        // SUB SP, #imm7 * 4.
        0xB080..=0xB0FF => Some(Step::Push(4 * u64::from(word & 0x7F))),
        // B with a condition.
        0xD000..=0xDDFF => Some(target(address, signed(word & 0xFF, 8) * 2)),
        // UDF, BKPT.
        0xDE00..=0xDEFF | 0xBE00..=0xBEFF => Some(Step::Trap),
        // CBZ, CBNZ.
        _ if code & 0xF500 == 0xB100 => {
            let offset = (word >> 9 & 1) << 6 | (word >> 3 & 0x1F) << 1;
            Some(target(address, offset.into()))
        }
        // B.
        0xE000..=0xE7FF => Some(target(address, signed(word & 0x7FF, 11) * 2)),
        // BX register; BX LR goes back.
        0x4700..=0x477F if code & 0x78 != 0x70 => Some(Step::Open),
        // BLX register that may have any value.
        0x4780..=0x47FF => Some(Step::Open),
        // ADD SP, register. MOV SP, register takes it back up.
        _ if code & 0xFF87 == 0x4485 => Some(Step::Open),
        _ => None,
    }
}

fn wide(first: u16, second: u16, address: u64) -> Option<Step> {
    let (a, b) = (u32::from(first), u32::from(second));
    match first {
        // PUSH.W (STMDB SP!).
        0xE92D => Some(Step::Push(4 * u64::from(b.count_ones()))),
        // STR Rt, [SP, #-imm8]!, of which PUSH of one register is one.
        0xF84D if b & 0xF00 == 0xD00 => Some(Step::Push(u64::from(b & 0xFF))),
        // STRD Rt, Rt2, [SP, #-imm8 * 4]!.
        0xE96D => Some(Step::Push(4 * u64::from(b & 0xFF))),
        // VPUSH, in words either way.
        _ if a & 0xFFBF == 0xED2D => Some(Step::Push(4 * u64::from(b & 0xFF))),
        // SUB.W SP, SP, #constant.
        0xF1AD | 0xF5AD if b & 0x8F00 == 0x0D00 => {
            let code = (a >> 10 & 1) << 11 | (b >> 12 & 7) << 8 | b & 0xFF;
            Some(expanded(code).map_or(Step::Open, |bytes| Step::Push(bytes.into())))
        }
        // SUBW SP, SP, #imm12.
        0xF2AD | 0xF6AD if b & 0x8F00 == 0x0D00 => {
            let bytes = (a >> 10 & 1) << 11 | (b >> 12 & 7) << 8 | b & 0xFF;
            Some(Step::Push(bytes.into()))
        }
        // LDR PC; POP of PC goes back.
        _ if a & 0xFF70 == 0xF850 && b >> 12 == 15 => {
            ((first, second) != (0xF85D, 0xFB04)).then_some(Step::Open)
        }
        // LDM with PC; from the stack it goes back.
        _ if matches!(a & 0xFFD0, 0xE890 | 0xE910) && b >> 15 == 1 => {
            (first != 0xE8BD).then_some(Step::Open)
        }
        // TBB and TBH whose table stands elsewhere.
        _ if a & 0xFFF0 == 0xE8D0 && b & 0xFFE0 == 0xF000 && first != 0xE8DF => Some(Step::Open),
        // UDF.W.
        0xF7F0..=0xF7FF if b & 0xF000 == 0xA000 => Some(Step::Trap),
        // BL, and B.W without a condition.
        0xF000..=0xF7FF if b & 0x9000 == 0x9000 => {
            let s = a >> 10 & 1;
            let [i1, i2] = [b >> 13 & 1, b >> 11 & 1].map(|j| 1 ^ j ^ s);
            let offset = s << 24 | i1 << 23 | i2 << 22 | (a & 0x3FF) << 12 | (b & 0x7FF) << 1;
            Some(target(address, signed(offset, 25)))
        }
        // B.W with a condition; conditions of 0b111x are other instructions.
        0xF000..=0xF7FF if b & 0xD000 == 0x8000 && a >> 7 & 7 != 7 => {
            let (s, j1, j2) = (a >> 10 & 1, b >> 13 & 1, b >> 11 & 1);
            let offset = s << 20 | j2 << 19 | j1 << 18 | (a & 0x3F) << 12 | (b & 0x7FF) << 1;
            Some(target(address, signed(offset, 21)))
        }
        _ => None,
    }
}

/// A constant of twelve coded bits that is one byte, rotated or not (A5.3.2);
/// `None` for repeated bytes, which are no size of a stack.
fn expanded(code: u32) -> Option<u32> {
    let rotation = code >> 7;
    match rotation {
        0 | 1 => Some(code & 0xFF),
        8.. => Some((code & 0x7F | 0x80).rotate_right(rotation)),
        _ => None,
    }
}
