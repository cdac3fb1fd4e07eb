//! As much of Thumb code as stack and calls need, as llvm-objdump shows it, which comes with the
//! toolchain: what moves the stack pointer down, and what goes somewhere else. What cannot be
//! followed is [`Step::Open`].

mod jump;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::run::{Fault, output, top};

/// What an instruction does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Step {
    Push(u64),
    Go(u64),
    /// Goes wherever a register or a word in memory says, or moves the stack by one.
    Open,
    Trap,
}

pub(super) struct Instruction {
    pub(super) address: u64,
    end: u64,
    name: String,
    operands: String,
    /// Where it goes, or where the constant lies that it loads.
    refers_to: Option<u64>,
}

/// The instructions of a program, in order of address.
pub(super) fn disassembled(elf: &Path) -> Result<Vec<Instruction>, Fault> {
    let mut compiler = Command::new("rustc");
    compiler.args(["--print", "target-libdir"]);
    let libraries = PathBuf::from(output(compiler.current_dir(top()))?.trim());
    let mut tool = Command::new(libraries.with_file_name("bin").join("llvm-objdump"));
    let said = output(tool.args(["--disassemble", "--section=.text"]).arg(elf))?;
    Ok(said.lines().filter_map(Instruction::read).collect())
}

/// A function: its instructions, and its bytes from an address on, which hold constants too.
pub(super) struct Code<'c> {
    pub(super) instructions: &'c [Instruction],
    pub(super) bytes: &'c [u8],
    pub(super) begin: u64,
}

impl Code<'_> {
    /// What it does, in order of address.
    pub(super) fn steps(&self) -> Vec<Step> {
        let numbers = 0..self.instructions.len();
        let step = |number| {
            let (before, rest) = self.instructions.split_at(number);
            self.step(before, &rest[0])
        };
        numbers.filter_map(step).collect()
    }

    fn step(&self, before: &[Instruction], code: &Instruction) -> Option<Step> {
        let Instruction { name, operands, .. } = code;
        let is = |start: &str| name.starts_with(start);
        let (first, rest) = operands.split_once(", ").unwrap_or((operands, ""));
        if let Some(stays) = self.stays(before, code) {
            return (!stays).then_some(Step::Open);
        }
        if is("udf") || is("bkpt") {
            return Some(Step::Trap);
        }
        if is("push") || is("vpush") {
            let each = if operands.contains('d') { 8 } else { 4 };
            return Some(Step::Push(each * operands.split(',').count() as u64));
        }
        // A store that takes the room for it.
        if let Some((_, bytes)) = operands.split_once("[sp, #-") {
            return number(bytes.strip_suffix("]!")?).map(Step::Push);
        }
        match (first, rest.strip_prefix("sp, ").unwrap_or(rest)) {
            ("sp", by) if is("add") || is("sub") => match by.strip_prefix('#') {
                Some(_) if is("add") => None,
                Some(bytes) => number(bytes).map(Step::Push),
                // From another register, to where it was before.
                None if by.contains('#') => None,
                None => Some(self.frame(before, by).map_or(Step::Open, Step::Push)),
            },
            ("lr", "") if is("bx") => None,
            (register, "") if is("bx") || is("blx") => {
                let called = self.called(before, register);
                Some(called.map_or(Step::Open, Step::Go))
            }
            // From the stack it goes back.
            ("pc", from) if is("ldr") && !from.starts_with("[sp]") => Some(Step::Open),
            (from, list) if is("ldm") && list.contains("pc") && !from.starts_with("sp") => {
                Some(Step::Open)
            }
            _ => code.refers_to.filter(|_| is("b") || is("cb")).map(Step::Go),
        }
    }

    /// The bytes of stack that are taken by ADD SP, `register`, where the instruction before loads
    /// that with a constant below zero: how a core without SUBW takes a large frame.
    fn frame(&self, before: &[Instruction], register: &str) -> Option<u64> {
        let load = before.last().filter(|code| code.is_load_to(register))?;
        let moved = self.word(load.refers_to?)?.cast_signed();
        (moved < 0).then(|| moved.unsigned_abs().into())
    }

    /// The function that is called by a register that holds a constant, which the last
    /// instruction to write it has loaded, or moved from another: how several calls of one function
    /// take less room.
    fn called<'r>(&'r self, before: &'r [Instruction], register: &'r str) -> Option<u64> {
        let last = before.iter().rposition(|code| code.may_write(register))?;
        let writer = &before[last];
        let moved = writer.operands.split_once(", ");
        if let Some((_, from)) = moved.filter(|(to, _)| writer.name == "mov" && *to == register) {
            return self.called(&before[..last], from);
        }
        let load = Some(writer).filter(|code| code.is_load_to(register))?;
        let address = u64::from(self.word(load.refers_to?)?);
        (address & 1 == 1).then_some(address & !1)
    }

    fn word(&self, address: u64) -> Option<u32> {
        let at = usize::try_from(address.checked_sub(self.begin)?).ok()?;
        let bytes = self.bytes.get(at..)?.first_chunk()?;
        Some(u32::from_le_bytes(*bytes))
    }

    fn has(&self, address: u64) -> bool {
        (self.begin..self.begin + self.bytes.len() as u64).contains(&address)
    }
}

fn number(text: &str) -> Option<u64> {
    u64::from_str_radix(text.trim_start_matches("0x"), 16).ok()
}

/// Instructions that write none of the registers that they name.
const READ_ONLY: [&str; 12] = [
    "blx", "bx", "cb", "cmn", "cmp", "push", "st", "teq", "tst", "vcmp", "vpush", "vst",
];
/// What a call leaves with any value.
const LOST_BY_A_CALL: [&str; 5] = ["r0", "r1", "r2", "r3", "r12"];

impl Instruction {
    /// Of a line: address, bytes, name and operands, and behind them what these come to.
    fn read(line: &str) -> Option<Self> {
        let mut columns = line.splitn(3, '\t');
        let (address, bytes) = columns.next()?.split_once(": ")?;
        let address = number(address.trim())?;
        let name = columns.next().filter(|name| !name.starts_with('.'))?;
        let rest = columns.next().unwrap_or_default();
        let (referring, _) = rest.split_once(" <").unwrap_or_default();
        let refers_to = referring.rsplit_once("0x");
        let operands = rest.split(['@', '<']).next().unwrap_or_default();
        let halves = bytes.split_whitespace().count() as u64;
        Some(Self {
            address,
            end: address + 2 * halves,
            name: name.to_owned(),
            operands: operands.trim_end().to_owned(),
            refers_to: refers_to.and_then(|(_, digits)| number(digits)),
        })
    }

    /// Whether it loads a constant from beside the code.
    fn is_load(&self) -> bool {
        self.operands.contains("[pc, #")
    }

    fn is_load_to(&self, register: &str) -> bool {
        let (to, from) = self.operands.split_once(", ").unwrap_or_default();
        ["ldr", "ldr.w"].contains(&&*self.name) && to == register && from.starts_with("[pc")
    }

    /// Whether it may write a register: more than it does, where that is shorter to say.
    fn may_write(&self, register: &str) -> bool {
        let is = |name: &&str| self.name.starts_with(*name);
        let moves_base = self.operands.contains('!') || self.operands.contains("],");
        // What a move takes from stays as it is.
        let end = if self.name == "mov" { ',' } else { '[' };
        let outside = self.operands.split(end).next().unwrap_or_default();
        let named = match (moves_base, READ_ONLY.iter().any(is)) {
            (true, _) => &self.operands,
            (false, true) => "",
            (false, false) => outside,
        };
        let mut names = named.split(|c: char| !c.is_ascii_alphanumeric());
        let loses = is(&"bl") && LOST_BY_A_CALL.contains(&register);
        loses || is(&"strex") || names.any(|name| name == register)
    }
}
