//! What code is in a program: the functions that have instructions in flash,
//! by name. Whole-program optimisation inlines nearly all of them, so symbols
//! alone prove little; the debug information says where each instruction came
//! from, whether its function stands by itself or inside another.

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::Path;

use gimli::{AttributeValue, Dwarf, EndianSlice, LittleEndian};
use object::{Object, ObjectSection};

use crate::firmware::with_elf;
use crate::run::Fault;

type Bytes<'a> = EndianSlice<'a, LittleEndian>;
type Unit<'a> = gimli::Unit<Bytes<'a>>;
type Entry<'u, 'a> = gimli::DebuggingInformationEntry<'u, 'u, Bytes<'a>>;

/// Begin and end of a piece of code.
pub(crate) type Piece = [u64; 2];

/// Flash of every board, and room for more of it. What the linker dropped has
/// addresses outside.
const FLASH: Range<u64> = 0x0800_0000..0x0900_0000;

/// Code, constants, and the model that a program brings with it.
const SECTIONS: [&str; 3] = [".text", ".rodata", ".model"];

/// Steps from an instance of a function to its declaration; in practice two.
const REFERENCES: usize = 8;

/// Names of the functions of `elf` that have instructions: paths without their
/// generic arguments, such as `whisking::gate::Rcp<R>::step`.
pub(crate) fn functions(elf: &Path) -> Result<BTreeSet<String>, Fault> {
    let names = entries(elf, |dwarf, units, unit, entry| {
        let is_code = [gimli::DW_TAG_subprogram, gimli::DW_TAG_inlined_subroutine];
        if is_code.contains(&entry.tag()) && !in_flash(dwarf, unit, entry)?.is_empty() {
            name(dwarf, units, unit, entry)
        } else {
            Ok(None)
        }
    })?;
    if names.is_empty() {
        return Err(format!("{}: no function is named", elf.display()));
    }
    Ok(names)
}

/// Where the code of functions stands that are inside others, of those whose names
/// `are_meant`: begin and end of each piece.
pub(crate) fn inlined(elf: &Path, are_meant: impl Fn(&str) -> bool) -> Result<Vec<Piece>, Fault> {
    let pieces = entries(elf, |dwarf, units, unit, entry| {
        if entry.tag() != gimli::DW_TAG_inlined_subroutine {
            return Ok(None);
        }
        match name(dwarf, units, unit, entry)? {
            Some(name) if are_meant(&name) => in_flash(dwarf, unit, entry).map(Some),
            _ => Ok(None),
        }
    })?;
    Ok(pieces.into_iter().flatten().collect())
}

/// How often `bytes` stand in flash.
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

/// What `pick` finds in the entries of the debug information of `elf`.
fn entries<T: Ord>(
    elf: &Path,
    pick: impl for<'a> Fn(
        &Dwarf<Bytes<'a>>,
        &[Unit<'a>],
        &Unit<'a>,
        &Entry<'_, 'a>,
    ) -> Result<Option<T>, gimli::Error>,
) -> Result<BTreeSet<T>, Fault> {
    with_elf(elf, |file| {
        let section = |id: gimli::SectionId| -> Result<Bytes<'_>, gimli::Error> {
            let data = file.section_by_name(id.name()).map(|s| s.data());
            let data = data.and_then(Result::ok).unwrap_or_default();
            Ok(EndianSlice::new(data, LittleEndian))
        };
        let dwarf = Dwarf::load(section)?;
        let mut units = Vec::new();
        let mut headers = dwarf.units();
        while let Some(header) = headers.next()? {
            units.push(dwarf.unit(header)?);
        }
        let mut found = BTreeSet::new();
        for unit in &units {
            let mut entries = unit.entries();
            while let Some((_, entry)) = entries.next_dfs()? {
                found.extend(pick(&dwarf, &units, unit, entry)?);
            }
        }
        Ok::<_, gimli::Error>(found)
    })
}

/// Where the code of an entry stands in flash.
fn in_flash<'a>(
    dwarf: &Dwarf<Bytes<'a>>,
    unit: &Unit<'a>,
    entry: &Entry<'_, 'a>,
) -> Result<Vec<Piece>, gimli::Error> {
    let mut ranges = dwarf.die_ranges(unit, entry)?;
    let mut pieces = Vec::new();
    while let Some(range) = ranges.next()? {
        if FLASH.contains(&range.begin) && range.end > range.begin {
            pieces.push([range.begin, range.end]);
        }
    }
    Ok(pieces)
}

/// The demangled name of a function, which may stand with what the entry is an
/// instance of.
fn name<'a, 'u>(
    dwarf: &Dwarf<Bytes<'a>>,
    units: &'u [Unit<'a>],
    unit: &'u Unit<'a>,
    entry: &Entry<'_, 'a>,
) -> Result<Option<String>, gimli::Error> {
    let (mut unit, mut entry) = (unit, entry.clone());
    for _ in 0..REFERENCES {
        if let Some(value) = entry.attr_value(gimli::DW_AT_linkage_name)? {
            let mangled = dwarf.attr_string(unit, value)?.to_string_lossy();
            return Ok(Some(format!("{:#}", rustc_demangle::demangle(&mangled))));
        }
        let reference = match entry.attr_value(gimli::DW_AT_abstract_origin)? {
            None => entry.attr_value(gimli::DW_AT_specification)?,
            origin => origin,
        };
        let (next, offset) = match reference {
            Some(AttributeValue::UnitRef(offset)) => (unit, offset),
            Some(AttributeValue::DebugInfoRef(offset)) => {
                let within =
                    |unit: &'u Unit<'a>| Some((unit, offset.to_unit_offset(&unit.header)?));
                let Some(found) = units.iter().find_map(within) else {
                    return Ok(None);
                };
                found
            }
            _ => return Ok(None),
        };
        unit = next;
        entry = unit.entry(offset)?;
    }
    Ok(None)
}
