//! Jumps by a table of constants that follows them, which the compiler makes of a choice among
//! many: they stay in their function if every entry of the table does.

use super::{Code, Instruction};

/// What fills a table up to a whole word: MOV r8, r8, and NOP. No table has such an entry, which
/// would lead further than a function is long.
const FILLS: [[u8; 2]; 2] = [[0xC0, 0x46], [0x00, 0xBF]];

impl Code<'_> {
    /// Whether an instruction stays here that jumps by a table; `before` is the code before it.
    pub(super) fn stays(&self, before: &[Instruction], code: &Instruction) -> Option<bool> {
        let last = &before[before.len().saturating_sub(4)..];
        let (first, rest) = code.operands.split_once(", ")?;
        let forward = |entry: u64| self.has(code.address + 4 + 2 * entry);
        let by_bytes = || all(self.table(code), |[byte]| forward(byte.into()));
        let by_halves = || {
            all(self.table(code), |half| {
                forward(u16::from_le_bytes(half).into())
            })
        };
        let to_words = || {
            let is_here = |word| self.has((u32::from_le_bytes(word) & !1).into());
            all(self.table(code), is_here)
        };
        // A table that stands behind constants has its address taken just before.
        let is_known = |base: &str| {
            let base = base.trim_start_matches('[');
            base == "pc" || last.last().is_some_and(|code| code.is_address_to(base))
        };
        match (&*code.name, first) {
            ("tbb", base) => Some(is_known(base) && by_bytes()),
            ("tbh", base) => Some(is_known(base) && by_halves()),
            // To an address, or to one of the branches that follow, whose own addresses are read: the
            // choice is added to the first's.
            (name, "pc") if name.starts_with("mov") => {
                Some(last.iter().any(|code| code.is_address_to(rest)) || to_words())
            }
            // As a core without TBB takes a table: the instruction two before took the entry.
            (name, "pc") if name.starts_with("add") => {
                let loads = last.iter().nth_back(1).map_or("", |code| &code.name);
                Some(match loads.get(..4) {
                    Some("ldrb") => by_bytes(),
                    Some("ldrh") => by_halves(),
                    _ => false,
                })
            }
            _ => None,
        }
    }

    /// The first constants behind an instruction that are not loaded by themselves.
    fn table(&self, code: &Instruction) -> &[u8] {
        let at = code.end;
        let end = self.begin + self.bytes.len() as u64;
        let covers = |code: &Instruction, at: u64| (code.address..code.end).contains(&at);
        let is_code = |at: u64| self.instructions.iter().any(|code| covers(code, at));
        let is_data = |at: &u64| self.has(*at) && !is_code(*at);
        let loads = self.instructions.iter().filter(|code| code.is_load());
        let literals: Vec<u64> = loads.filter_map(|code| code.refers_to).collect();
        let is_literal = |at: &u64| literals.contains(&(at & !3));
        // A table of words may stand behind two bytes that fill.
        let data = [at, at + 2].into_iter().find(is_data).unwrap_or(at);
        let mut constants = (data..end).take_while(is_data);
        let from = constants.find(|at| !is_literal(at)).unwrap_or(data);
        let is_entry = |at: &u64| is_data(at) && !is_literal(at);
        let to = from + (from..end).take_while(is_entry).count() as u64;
        let [from, to] = [from, to].map(|at| (at - self.begin) as usize);
        let table = self.bytes.get(from..to).unwrap_or_default();
        let filled = FILLS.iter().find_map(|fill| table.strip_suffix(fill));
        filled.unwrap_or(table)
    }
}

impl Instruction {
    /// Whether it takes the address of what follows to this register.
    fn is_address_to(&self, register: &str) -> bool {
        let to = self.operands.split_once(", ").map(|(to, _)| to);
        self.name == "adr.w" && to == Some(register)
    }
}

/// Whether there is a table, and all of its entries are so.
fn all<const N: usize>(table: &[u8], is_so: impl Fn([u8; N]) -> bool) -> bool {
    !table.is_empty() && table.as_chunks().0.iter().all(|entry| is_so(*entry))
}
