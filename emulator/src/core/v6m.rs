//! The instructions of ARMv6-M (ARMv6-M Architecture Reference Manual, A5.2 and A5.3):
//! those of 16 bits that ARMv7-M has but CBZ, CBNZ and IT, and six of 32 bits.

/// Whether ARMv6-M has the instruction that begins with the half-word `first`. One that is
/// permanently undefined counts as one that it has not.
pub(super) const fn is_known(first: u16, second: u16) -> bool {
    match first >> 11 {
        0b11101 | 0b11111 => false,
        0b11110 => is_known_wide(first, second),
        // BX and BLX: their low bits are zero.
        0b01000 if first & 0xFF00 == 0x4700 => first.trailing_zeros() >= 3,
        0b10110 | 0b10111 => is_known_misc(first),
        // A conditional branch of condition 14 is undefined.
        0b11011 => first & 0xFF00 != 0xDE00,
        _ => true,
    }
}

/// The miscellaneous ones of 16 bits (A5.2.5).
const fn is_known_misc(first: u16) -> bool {
    match (first >> 8) & 15 {
        // SP plus or minus a number; extensions; PUSH, POP; a breakpoint.
        0b0000 | 0b0010 | 0b0100 | 0b0101 | 0b1100..=0b1110 => true,
        // CPSIE i and CPSID i.
        0b0110 => first & 0xEF == 0x62,
        // REV, REV16, REVSH.
        0b1010 => first & 0xC0 != 0x80,
        // Hints; with low bits it is an IT.
        0b1111 => first.trailing_zeros() >= 4,
        _ => false,
    }
}

/// Those of 32 bits (A5.3.1).
const fn is_known_wide(first: u16, second: u16) -> bool {
    match (first, second) {
        // BL; DSB, DMB and ISB.
        (_, 0xD000..=0xDFFF | 0xF000..=0xFFFF) | (0xF3BF, 0x8F40..=0x8F6F) => true,
        // MSR and MRS.
        (0xF380..=0xF38F, 0x8800..=0x88FF) | (0xF3EF, 0x8000..=0x8FFF) => is_register(second),
        _ => false,
    }
}

/// Whether ARMv6-M has the special register of an MRS or MSR: the parts of PSR, the stack
/// pointers, PRIMASK and CONTROL.
const fn is_register(second: u16) -> bool {
    matches!(second & 0xFF, 0..=3 | 5..=9 | 16 | 20)
}
