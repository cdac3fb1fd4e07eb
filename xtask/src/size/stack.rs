//! A bound for the stack of a program, from its instructions: what each
//! function takes, which it calls, and the deepest way from the reset plus the
//! deepest interrupt. All interrupts of the firmware have one priority, so one
//! is on the stack at a time. Faults are apart: they end in a reset.
//!
//! Measured depths, by painting, are at most this.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use object::{Object, ObjectSection, ObjectSymbol, SymbolKind};

use super::thumb::{self, Step};
use crate::firmware::{Board, with_elf};
use crate::run::Fault;

/// What the core itself puts on the stack at an interrupt: eight words; with an
/// FPU eighteen more; and one for alignment.
const EXCEPTION: u64 = 9 * 4;
const EXCEPTION_FPU: u64 = EXCEPTION + 18 * 4;

/// Words of the vector table before the chip's interrupts.
const CORE_VECTORS: usize = 16;
/// The word of the reset.
const RESET: usize = 1;

/// Functions that no way comes back from: a panic or another fault.
const FAULTS: [&str; 3] = ["core::panicking::", "rust_begin_unwind", "board::faults::"];

/// A function of the program.
struct Function {
    name: String,
    /// Bytes that it takes itself.
    own: u64,
    /// Where those begin that it calls.
    calls: BTreeSet<u64>,
    /// It calls through a pointer.
    is_open: bool,
}

/// The most bytes of stack that `elf` takes on `board`.
///
/// # Errors
/// If the file cannot be read, or holds something that has no bound: a
/// recursion, a call through a pointer.
pub(super) fn worst(board: Board, elf: &Path) -> Result<u64, Fault> {
    with_elf(elf, |file| bound(board, file))
}

fn bound(board: Board, file: &object::File<'_>) -> Result<u64, Fault> {
    let functions = functions(file).map_err(|error| error.to_string())?;
    let vectors = vectors(file).map_err(|error| error.to_string())?;
    let reset = *vectors.get(RESET).ok_or("no vectors")?;
    // Interrupts without a task share one handler, which is a fault.
    let tasks = vectors.get(CORE_VECTORS..).unwrap_or_default();
    let count = |vector: &u64| tasks.iter().filter(|other| *other == vector).count();
    let mut interrupt = 0;
    for task in tasks.iter().filter(|task| **task != 0 && count(task) == 1) {
        interrupt = depth(&functions, *task, &mut Vec::new())?.max(interrupt);
    }
    if interrupt == 0 {
        return Err("no task is bound to an interrupt".to_owned());
    }
    let exception = if board.has_fpu {
        EXCEPTION_FPU
    } else {
        EXCEPTION
    };
    Ok(depth(&functions, reset, &mut Vec::new())? + exception + interrupt)
}

/// Bytes from the entry of the function at `start` to the deepest of those it
/// calls; `way` is how it was reached.
fn depth(
    functions: &BTreeMap<u64, Function>,
    start: u64,
    way: &mut Vec<u64>,
) -> Result<u64, String> {
    let unknown = || format!("{start:#x} is called, and no function begins there");
    let function = functions.get(&start).ok_or_else(unknown)?;
    if FAULTS.iter().any(|fault| function.name.contains(fault)) {
        return Ok(0);
    }
    if way.contains(&start) {
        return Err(format!("{} calls itself", function.name));
    }
    if function.is_open {
        return Err(format!("{} calls through a pointer", function.name));
    }
    way.push(start);
    let mut below = 0;
    for call in &function.calls {
        below = depth(functions, *call, way)?.max(below);
    }
    way.pop();
    Ok(function.own + below)
}

/// The addresses in the vector table, without the bit that says Thumb.
fn vectors(file: &object::File<'_>) -> Result<Vec<u64>, object::Error> {
    let Some(section) = file.section_by_name(".vector_table") else {
        return Ok(Vec::new());
    };
    let words = section.data()?.as_chunks::<4>().0;
    let address = |word: &[u8; 4]| u64::from(u32::from_le_bytes(*word) & !1);
    Ok(words.iter().map(address).collect())
}

/// The functions, by where they begin.
fn functions(file: &object::File<'_>) -> Result<BTreeMap<u64, Function>, object::Error> {
    let mut functions = BTreeMap::new();
    let Some(text) = file.section_by_name(".text") else {
        return Ok(functions);
    };
    let (data, origin) = (text.data()?, text.address());
    // `$t` and `$d` say where instructions and where constants begin.
    let mut is_code = BTreeMap::new();
    for symbol in file.symbols() {
        match symbol.name()?.get(..2) {
            Some("$t") => is_code.insert(symbol.address(), true),
            Some("$d") => is_code.insert(symbol.address(), false),
            _ => None,
        };
    }
    for symbol in file.symbols() {
        let begin = symbol.address() & !1;
        let end = begin + symbol.size();
        let is_function = symbol.kind() == SymbolKind::Text && symbol.size() > 0;
        let Some(range) = begin.checked_sub(origin).zip(end.checked_sub(origin)) else {
            continue;
        };
        let Some(body) = data.get(range.0 as usize..range.1 as usize) else {
            continue;
        };
        if !is_function {
            continue;
        }
        let mut function = Function {
            name: format!("{:#}", rustc_demangle::demangle(symbol.name()?)),
            own: 0,
            calls: BTreeSet::new(),
            is_open: false,
        };
        let is_instruction = |address: u64| {
            let mark = is_code.range(..=address).next_back();
            mark.is_none_or(|(_, is_code)| *is_code)
        };
        for step in thumb::steps(body, begin, is_instruction) {
            match step {
                Step::Push(bytes) => function.own += bytes,
                Step::Go(to) if (begin..end).contains(&to) => {}
                Step::Go(to) => {
                    function.calls.insert(to);
                }
                Step::Open => function.is_open = true,
            }
        }
        functions.insert(begin, function);
    }
    Ok(functions)
}
