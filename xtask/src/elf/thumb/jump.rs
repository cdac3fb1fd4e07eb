//! Jumps by a table, which the compiler makes of a choice among many: they stay in their
//! function if every entry of the table does.

use std::ops::Range;

/// What fills a table up to a whole word: MOV r8, r8, and NOP. No table has such an entry, which
/// would lead further than a function is long.
const FILLS: [[u8; 2]; 2] = [[0xC0, 0x46], [0x00, 0xBF]];

/// A jump by a table of constants that follows it.
#[derive(Debug, Clone, Copy)]
pub(super) enum Jump {
    /// Forward by twice a byte.
    Bytes,
    /// Forward by twice a half word.
    Halves,
    /// To an address.
    Words,
    /// To one of the branches that follow it, whose own addresses are read.
    Branches,
    /// Who knows where to.
    Unknown,
}

impl Jump {
    /// ADD PC, register and MOV PC, register, as a core without TBB takes a table:
    /// `loads` is the instruction two before, which took the entry from it.
    pub(super) fn narrow(code: u16, loads: u16) -> Option<Self> {
        let is_add = code & 0xFF87 == 0x4487;
        match loads >> 9 {
            _ if code & 0xFF87 == 0x4687 => Some(Self::Words),
            // LDRB and LDRH, from an address and a constant or a register.
            0b011_1100..=0b011_1111 | 0b010_1110 if is_add => Some(Self::Bytes),
            0b100_0100..=0b100_0111 | 0b010_1101 if is_add => Some(Self::Halves),
            _ => is_add.then_some(Self::Unknown),
        }
    }

    /// TBB and TBH.
    pub(super) fn wide(first: u16, second: u16) -> Option<Self> {
        match (first & 0xFFF0, second & 0xFFF0) {
            (0xE8D0, 0xF000) => Some(Self::Bytes),
            (0xE8D0, 0xF010) => Some(Self::Halves),
            _ => None,
        }
    }

    /// Whether every entry of `table`, which there must be, goes to an address that
    /// `is_within`.
    pub(super) fn stays(self, table: &[u8], address: u64, is_within: impl Fn(u64) -> bool) -> bool {
        let forward = |entry: u64| is_within(address + 4 + 2 * entry);
        let halves = table.as_chunks::<2>().0.iter();
        let words = table.as_chunks::<4>().0.iter();
        matches!(self, Self::Branches)
            || !table.is_empty()
                && match self {
                    Self::Bytes => table.iter().all(|byte| forward((*byte).into())),
                    Self::Halves => halves.map(|h| u16::from_le_bytes(*h).into()).all(forward),
                    Self::Unknown | Self::Branches => false,
                    Self::Words => words
                        .map(|word| u64::from(u32::from_le_bytes(*word) & !1))
                        .all(is_within),
                }
    }
}

/// The table of a jump that ends at `at`: of the bytes of `body`, at addresses `place`, the
/// first constants behind it that `is_literal` does not say are loaded by themselves.
pub(super) fn table<'b>(
    body: &'b [u8],
    place: &Range<u64>,
    at: u64,
    is_instruction: impl Fn(u64) -> bool,
    is_literal: impl Fn(u64) -> bool,
) -> &'b [u8] {
    let is_data = |at: &u64| place.contains(at) && !is_instruction(*at);
    // A table of words may stand behind two bytes that fill.
    let data = [at, at + 2].into_iter().find(is_data).unwrap_or(at);
    let mut constants = (data..place.end).take_while(is_data);
    let from = constants.find(|at| !is_literal(*at)).unwrap_or(data);
    let is_entry = |at: &u64| is_data(at) && !is_literal(*at);
    let to = from + (from..place.end).take_while(is_entry).count() as u64;
    let [from, to] = [from, to].map(|at| (at - place.start) as usize);
    let table = body.get(from..to).unwrap_or_default();
    let filled = FILLS.iter().find_map(|fill| table.strip_suffix(fill));
    filled.unwrap_or(table)
}
