//! As much of Thumb code as the stack's depth needs (Arm v7-M Architecture
//! Reference Manual, chapters A5 and A7): what moves the stack pointer down,
//! and what goes somewhere else.

/// What an instruction does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Step {
    /// Takes bytes of stack.
    Push(u64),
    /// Calls or branches to an address.
    Go(u64),
    /// Calls whatever a register says, or moves the stack by one.
    Open,
}

/// The steps of a function whose code `body` begins at address `begin`, in
/// order of address; `is_instruction` tells instructions from constants.
pub(super) fn steps(body: &[u8], begin: u64, is_instruction: impl Fn(u64) -> bool) -> Vec<Step> {
    let half = |at: usize| -> Option<u16> {
        let bytes = body.get(at..at + 2)?;
        Some(u16::from_le_bytes([bytes[0], bytes[1]]))
    };
    let mut steps = Vec::new();
    let mut at = 0;
    while let Some(first) = half(at) {
        let address = begin + at as u64;
        at += 2;
        if !is_instruction(address) {
            continue;
        }
        // Three patterns of the top five bits begin an instruction of four bytes.
        if first >> 11 < 0b11101 {
            steps.extend(narrow(first, address));
        } else if let Some(second) = half(at) {
            at += 2;
            steps.extend(wide(first, second, address));
        }
    }
    steps
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
        // B.
        0xE000..=0xE7FF => Some(target(address, signed(word & 0x7FF, 11) * 2)),
        // BLX register; ADD SP, register; MOV SP, register.
        0x4780..=0x47FF => Some(Step::Open),
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

#[cfg(test)]
mod tests {
    use super::{Step, steps};

    /// As assembled by LLVM for thumbv7em at 0x0800_0000.
    #[test]
    fn what_moves_the_stack_is_read() {
        let cases: [(&[u16], &[Step]); 10] = [
            (&[0xB5F0], &[Step::Push(20)]),                   // push {r4-r7, lr}
            (&[0xB082], &[Step::Push(8)]),                    // sub sp, #8
            (&[0xE92D, 0x0F00], &[Step::Push(16)]),           // push.w {r8-r11}
            (&[0xF84D, 0xBD04], &[Step::Push(4)]),            // str r11, [sp, #-4]!
            (&[0xED2D, 0x8B04], &[Step::Push(16)]),           // vpush {d8, d9}
            (&[0xF5AD, 0x7D00], &[Step::Push(512)]),          // sub.w sp, sp, #512
            (&[0xF2AD, 0x4D04], &[Step::Push(1028)]),         // subw sp, sp, #1028
            (&[0x4798], &[Step::Open]),                       // blx r3
            (&[0x44A5], &[Step::Open]),                       // add sp, r4
            (&[0xB002, 0xBDF0, 0x4770, 0xF84D, 0xB004], &[]), // add sp; pop; bx lr; str [sp, r4]
        ];
        for (halves, expected) in cases {
            let bytes: Vec<u8> = halves.iter().flat_map(|h| h.to_le_bytes()).collect();
            let found = steps(&bytes, 0x0800_0000, |_| true);
            assert_eq!(found, expected, "{halves:04x?}");
        }
    }

    #[test]
    fn where_branches_go_is_read() {
        let cases: [(&[u16], u64); 5] = [
            (&[0xF000, 0xF801], 0x0800_0006), // bl +2
            (&[0xF7FF, 0xFFFE], 0x0800_0000), // bl -4
            (&[0xF000, 0xB8FE], 0x0800_0200), // b.w +0x1fc
            (&[0xE7FE], 0x0800_0000),         // b .
            (&[0xF43F, 0xAFFE], 0x0800_0000), // beq.w .
        ];
        for (halves, expected) in cases {
            let bytes: Vec<u8> = halves.iter().flat_map(|h| h.to_le_bytes()).collect();
            let found = steps(&bytes, 0x0800_0000, |_| true);
            assert_eq!(found, [Step::Go(expected)], "{halves:04x?}");
        }
    }

    #[test]
    fn constants_are_no_instructions() {
        let bytes = [0x30, 0xB5, 0x30, 0xB5];
        assert_eq!(steps(&bytes, 0, |at| at == 0), [Step::Push(12)]);
    }
}
