//! Which function of a program calls which, from its instructions, and where its interrupts begin.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::Path;

use object::{Object, ObjectSection, ObjectSymbol, SymbolKind};

use super::thumb::{self, Code, Instruction, Step};
use crate::firmware::with_elf;
use crate::run::Fault;

/// Words of the vector table before the chip's interrupts.
const CORE_VECTORS: usize = 16;
const RESET: usize = 1;

pub(crate) struct Function {
    pub(crate) name: String,
    pub(crate) range: Range<u64>,
    /// Bytes of stack that it takes itself.
    pub(crate) own: u64,
    /// Where those begin that it calls.
    pub(crate) calls: BTreeSet<u64>,
    /// It calls through a pointer.
    pub(crate) is_open: bool,
    /// It holds an instruction that stops the program: an abort.
    pub(crate) traps: bool,
}

/// The functions of a program, and where the hardware enters it.
pub(crate) struct Calls {
    functions: BTreeMap<u64, Function>,
    /// The addresses in the vector table, without the bit that says Thumb.
    vectors: Vec<u64>,
}

impl Calls {
    pub(crate) fn of(elf: &Path) -> Result<Self, Fault> {
        let instructions = thumb::disassembled(elf)?;
        with_elf(elf, |file| {
            Ok::<_, object::Error>(Self {
                functions: functions(file, &instructions)?,
                vectors: vectors(file)?,
            })
        })
    }

    /// Of functions that name one another by address, entered at the first.
    #[cfg(test)]
    pub(crate) fn among(functions: impl IntoIterator<Item = Function>) -> Self {
        let functions = functions.into_iter().map(|f| (f.range.start, f));
        Self {
            functions: functions.collect(),
            vectors: Vec::new(),
        }
    }

    pub(crate) fn at(&self, begin: u64) -> Result<&Function, Fault> {
        let unknown = || format!("{begin:#x} is called, and no function begins there");
        self.functions.get(&begin).ok_or_else(unknown)
    }

    pub(crate) fn reset(&self) -> Result<u64, Fault> {
        let reset = self.vectors.get(RESET).copied();
        reset.ok_or_else(|| "no vectors".to_owned())
    }

    /// Where the interrupts of tasks begin.
    pub(crate) fn tasks(&self) -> Result<Vec<u64>, Fault> {
        // Interrupts without a task share one handler, which is a fault.
        let vectors = self.vectors.get(CORE_VECTORS..).unwrap_or_default();
        let is_alone = |task: &u64| vectors.iter().filter(|other| *other == task).count() == 1;
        let tasks = vectors.iter().copied();
        let tasks: Vec<u64> = tasks.filter(|t| *t != 0 && is_alone(t)).collect();
        if tasks.is_empty() {
            return Err("no task is bound to an interrupt".to_owned());
        }
        Ok(tasks)
    }

    /// Where the functions begin whose names contain `part`.
    pub(crate) fn named(&self, part: &str) -> Vec<u64> {
        let functions = self.functions.iter();
        let named = functions.filter(|(_, function)| function.name.contains(part));
        named.map(|(begin, _)| *begin).collect()
    }
}

fn vectors(file: &object::File<'_>) -> Result<Vec<u64>, object::Error> {
    let Some(section) = file.section_by_name(".vector_table") else {
        return Ok(Vec::new());
    };
    let words = section.data()?.as_chunks::<4>().0;
    let address = |word: &[u8; 4]| u64::from(u32::from_le_bytes(*word) & !1);
    Ok(words.iter().map(address).collect())
}

fn functions(
    file: &object::File<'_>,
    instructions: &[Instruction],
) -> Result<BTreeMap<u64, Function>, object::Error> {
    let mut functions = BTreeMap::new();
    let Some(text) = file.section_by_name(".text") else {
        return Ok(functions);
    };
    let (data, origin) = (text.data()?, text.address());
    for symbol in file.symbols() {
        let begin = symbol.address() & !1;
        let range = begin..begin + symbol.size();
        if symbol.kind() != SymbolKind::Text || range.is_empty() {
            continue;
        }
        let place = range.start.checked_sub(origin);
        let place = place.zip(range.end.checked_sub(origin));
        let Some(body) = place.and_then(|(from, to)| data.get(from as usize..to as usize)) else {
            continue;
        };
        let name = format!("{:#}", rustc_demangle::demangle(symbol.name()?));
        let [from, to] = [range.start, range.end]
            .map(|end| instructions.partition_point(|code| code.address < end));
        let code = Code {
            instructions: &instructions[from..to],
            bytes: body,
            begin,
        };
        functions.insert(begin, function(name, range, code.steps()));
    }
    Ok(functions)
}

fn function(name: String, range: Range<u64>, steps: Vec<Step>) -> Function {
    let mut function = Function {
        name,
        range,
        own: 0,
        calls: BTreeSet::new(),
        is_open: false,
        traps: false,
    };
    for step in steps {
        match step {
            Step::Push(bytes) => function.own += bytes,
            Step::Go(to) if function.range.contains(&to) => {}
            Step::Go(to) => {
                function.calls.insert(to);
            }
            Step::Open => function.is_open = true,
            Step::Trap => function.traps = true,
        }
    }
    function
}
