//! Where variables and their members stand in memory, from the program's DWARF
//! as a debugger reads it.

mod leaves;
mod place;

use gimli::{
    AttributeValue, DW_AT_count, DW_AT_data_member_location, DW_AT_discr_value, DW_AT_location,
    DW_AT_name, DW_AT_type, DW_AT_upper_bound, DW_TAG_member, DW_TAG_variable,
    DebuggingInformationEntry, DwAt, DwTag, Dwarf, EndianRcSlice, LittleEndian, Operation, Unit,
    UnitOffset,
};
use object::{Object, ObjectSection};

use crate::chip::Fault;
use crate::program::Program;

pub(crate) use leaves::Leaf;
pub(crate) use place::{Number, Place};

type Reader = EndianRcSlice<LittleEndian>;
type Entry<'a> = DebuggingInformationEntry<'a, 'a, Reader>;

#[derive(Debug)]
pub(crate) struct DebugInfo {
    dwarf: Dwarf<Reader>,
    units: Vec<Unit<Reader>>,
}

/// A type: a unit and an entry in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Type {
    unit: usize,
    at: UnitOffset,
}

/// An entry directly below another: a member, a variant, or the range of an array.
struct Child {
    at: Type,
    tag: DwTag,
    name: Option<String>,
    /// Where a member is, and of what type.
    offset: Option<u32>,
    of: Option<Type>,
    /// The tag's value of a variant.
    value: Option<u64>,
    /// Of an array.
    length: Option<u32>,
}

fn bad(what: impl std::fmt::Display) -> Fault {
    Fault::Program(format!("debug information: {what}"))
}

impl DebugInfo {
    pub(crate) fn new(program: &Program) -> Result<Self, Fault> {
        let file = object::File::parse(program.bytes()).map_err(bad)?;
        let section = |id: gimli::SectionId| -> Result<Reader, gimli::Error> {
            let data = file
                .section_by_name(id.name())
                .and_then(|section| section.uncompressed_data().ok())
                .unwrap_or_default();
            Ok(EndianRcSlice::new(data.as_ref().into(), LittleEndian))
        };
        let dwarf = Dwarf::load(section).map_err(bad)?;
        let mut units = Vec::new();
        let mut headers = dwarf.units();
        while let Some(header) = headers.next().map_err(bad)? {
            units.push(dwarf.unit(header).map_err(bad)?);
        }
        Ok(Self { dwarf, units })
    }

    fn name(&self, unit: usize, entry: &Entry<'_>) -> Result<Option<String>, Fault> {
        let Some(name) = entry.attr_value(DW_AT_name).map_err(bad)? else {
            return Ok(None);
        };
        let unit = &self.units[unit];
        let name = self.dwarf.attr_string(unit, name).map_err(bad)?;
        Ok(Some(String::from_utf8_lossy(&name).into_owned()))
    }

    /// The address of a static variable: DW_OP_addr, perhaps with an offset
    /// where the linker has merged several.
    fn address(&self, unit: usize, entry: &Entry<'_>) -> Result<Option<u32>, Fault> {
        let Some(AttributeValue::Exprloc(expression)) =
            entry.attr_value(DW_AT_location).map_err(bad)?
        else {
            return Ok(None);
        };
        let encoding = self.units[unit].encoding();
        let mut operations = expression.operations(encoding);
        let mut found = None;
        while let Some(operation) = operations.next().map_err(bad)? {
            found = match (operation, found) {
                (Operation::Address { address }, None) => Some(address),
                (Operation::PlusConstant { value }, Some(address)) => Some(address + value),
                // Not in one place.
                _ => return Ok(None),
            };
        }
        Ok(found.map(|address| address as u32))
    }

    fn type_of(&self, unit: usize, entry: &Entry<'_>) -> Result<Option<Type>, Fault> {
        Ok(match entry.attr_value(DW_AT_type).map_err(bad)? {
            Some(AttributeValue::UnitRef(at)) => Some(Type { unit, at }),
            Some(AttributeValue::DebugInfoRef(offset)) => {
                let mut units = self.units.iter().enumerate();
                units.find_map(|(unit, u)| {
                    let at = offset.to_unit_offset(&u.header)?;
                    Some(Type { unit, at })
                })
            }
            _ => None,
        })
    }

    fn children(&self, of: Type) -> Result<Vec<Child>, Fault> {
        let unit = of.unit;
        let mut tree = self.units[unit].entries_tree(Some(of.at)).map_err(bad)?;
        let mut below = tree.root().map_err(bad)?.children();
        let mut children = Vec::new();
        while let Some(child) = below.next().map_err(bad)? {
            let entry = child.entry();
            let last = number(entry, DW_AT_upper_bound)?;
            let length = number(entry, DW_AT_count)?.or(last.map(|last| last + 1));
            children.push(Child {
                at: Type {
                    unit,
                    at: entry.offset(),
                },
                tag: entry.tag(),
                name: self.name(unit, entry)?,
                offset: number(entry, DW_AT_data_member_location)?.map(|offset| offset as u32),
                of: self.type_of(unit, entry)?,
                value: number(entry, DW_AT_discr_value)?,
                length: length.map(|length| length as u32),
            });
        }
        Ok(children)
    }

    /// The member of that name, directly below `of`, and its offset.
    fn member(&self, of: Type, name: &str) -> Result<Option<(u32, Type)>, Fault> {
        let mut children = self.children(of)?.into_iter();
        Ok(children.find_map(|child| {
            let is_it = child.tag == DW_TAG_member && child.name.as_deref() == Some(name);
            Some((child.offset.unwrap_or(0), child.of.filter(|_| is_it)?))
        }))
    }

    /// Walks over the variables that have an address, until `visit` has found something.
    fn variables<'d, T>(
        &'d self,
        mut visit: impl FnMut(String, Place<'d>) -> Result<Option<T>, Fault>,
    ) -> Result<Option<T>, Fault> {
        for unit in 0..self.units.len() {
            let mut entries = self.units[unit].entries();
            while let Some((_, entry)) = entries.next_dfs().map_err(bad)? {
                if entry.tag() == DW_TAG_variable
                    && let Some(address) = self.address(unit, entry)?
                    && let Some(name) = self.name(unit, entry)?
                    && let Some(of) = self.type_of(unit, entry)?
                {
                    let info = self;
                    let found = visit(name, Place { info, address, of })?;
                    if found.is_some() {
                        return Ok(found);
                    }
                }
            }
        }
        Ok(None)
    }

    pub(crate) fn variable(&self, name: &str) -> Result<Place<'_>, Fault> {
        let found = self.variables(|found, place| Ok((found == name).then_some(place)))?;
        found.ok_or_else(|| bad(format!("no variable {name}")))
    }
}

fn number(entry: &Entry<'_>, attribute: DwAt) -> Result<Option<u64>, Fault> {
    let value = entry.attr_value(attribute).map_err(bad)?;
    Ok(value.and_then(|value| value.udata_value()))
}
