//! What code is in a program: the functions that have instructions in flash, by name. Whole-program
//! optimisation inlines nearly all of them, so symbols alone prove little; the debug information
//! says where each instruction came from, whether its function stands by itself or inside another.

use std::collections::BTreeSet;
use std::path::Path;

use addr2line::Context;
use gimli::{Dwarf, EndianSlice, LittleEndian, SectionId};
use object::{Object, ObjectSection};

use crate::firmware::with_elf;
use crate::run::Fault;

/// Code, constants, and the model that a program brings with it.
const SECTIONS: [&str; 3] = [".text", ".rodata", ".model"];

/// Names of the functions of `elf` that have instructions: paths without their
/// generic arguments, such as `whisking::gate::Rcp<R>::step`.
pub(crate) fn functions(elf: &Path) -> Result<BTreeSet<String>, Fault> {
    let mut mangled = BTreeSet::new();
    each_instruction(elf, |_, names| mangled.extend(names))?;
    if mangled.is_empty() {
        return Err(format!("{}: no function is named", elf.display()));
    }
    Ok(mangled.iter().map(|name| demangled(name)).collect())
}

/// Addresses of instructions of functions that are inside others, of those whose names
/// `are_meant`.
pub(crate) fn inlined(elf: &Path, are_meant: impl Fn(&str) -> bool) -> Result<Vec<u64>, Fault> {
    let mut found = Vec::new();
    each_instruction(elf, |address, mut names| {
        // The outermost stands by itself.
        names.pop();
        if names.iter().any(|name| are_meant(&demangled(name))) {
            found.push(address);
        }
    })?;
    Ok(found)
}

pub(crate) fn occurrences(elf: &Path, bytes: &[u8]) -> Result<usize, Fault> {
    with_elf(elf, |file| {
        let mut found = 0;
        for name in SECTIONS {
            let data = file.section_by_name(name).map(|section| section.data());
            let data = data.transpose()?.unwrap_or_default();
            let windows = data.windows(bytes.len().max(1));
            found += windows.filter(|window| *window == bytes).count();
        }
        Ok::<_, object::Error>(found)
    })
}

fn demangled(name: &str) -> String {
    format!("{:#}", rustc_demangle::demangle(name))
}

/// Gives each address of code with the names of the functions that it belongs to, as the linker
/// has them, the innermost first.
fn each_instruction(elf: &Path, mut take: impl FnMut(u64, Vec<String>)) -> Result<(), Fault> {
    with_elf(elf, |file| {
        let section = |id: SectionId| -> Result<_, gimli::Error> {
            let data = file.section_by_name(id.name()).map(|s| s.data());
            let data = data.and_then(Result::ok).unwrap_or_default();
            Ok(EndianSlice::new(data, LittleEndian))
        };
        let context = Context::from_dwarf(Dwarf::load(section)?)?;
        let text = file.section_by_name(".text");
        let text = text.map_or(0..0, |text| text.address()..text.address() + text.size());
        for address in text.step_by(2) {
            let mut frames = context.find_frames(address).skip_all_loads()?;
            let mut names = Vec::new();
            while let Some(frame) = frames.next()? {
                if let Some(function) = frame.function {
                    names.push(function.raw_name()?.into_owned());
                }
            }
            take(address, names);
        }
        Ok::<_, gimli::Error>(())
    })
}
