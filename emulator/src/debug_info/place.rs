//! Walking from a variable to its parts by their names.

use gimli::{
    AttributeValue, DW_AT_byte_size, DW_AT_encoding, DW_ATE_float, DW_TAG_array_type,
    DW_TAG_base_type, DW_TAG_member, DW_TAG_structure_type, DW_TAG_union_type, DW_TAG_variant,
    DW_TAG_variant_part,
};

use super::{DebugInfo, Type, bad, number};
use crate::chip::Fault;

/// A variable, or a part of one: where it is and what it is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place<'d> {
    pub(super) info: &'d DebugInfo,
    pub(crate) address: u32,
    pub(super) of: Type,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Number {
    /// IEEE single precision.
    Single,
    /// An integer of four bytes: fixed point.
    Word,
}

/// Members that only wrap one other.
const WRAPPERS: [&str; 5] = ["value", "__0", "inner", "val", "buffer"];

/// Variants that hold what is there.
const PRESENT: [&str; 2] = ["Some", "Ok"];

impl Place<'_> {
    pub(super) fn part(self, offset: u32, of: Type) -> Self {
        Self {
            info: self.info,
            address: self.address + offset,
            of,
        }
    }

    /// The member of that name; cells and other wrappers around it are seen through.
    pub(crate) fn member(self, name: &str) -> Result<Self, Fault> {
        self.find(name)?
            .ok_or_else(|| bad(format!("no member {name}")))
    }

    pub(crate) fn find(self, name: &str) -> Result<Option<Self>, Fault> {
        if let Some((offset, of)) = self.info.member(self.of, name)? {
            return Ok(Some(self.part(offset, of)));
        }
        self.unwrapped()?.map_or(Ok(None), |inner| inner.find(name))
    }

    fn inner(self, what: impl std::fmt::Display) -> Result<Self, Fault> {
        self.unwrapped()?.ok_or_else(|| bad(what))
    }

    fn unwrapped(self) -> Result<Option<Self>, Fault> {
        for name in WRAPPERS {
            if let Some((offset, of)) = self.info.member(self.of, name)? {
                return Ok(Some(self.part(offset, of)));
            }
        }
        for name in PRESENT {
            if let Some((_, _, held)) = self.own_variant(name)? {
                return Ok(Some(held));
            }
        }
        Ok(None)
    }

    pub(super) fn tag(self) -> Result<gimli::DwTag, Fault> {
        let unit = &self.info.units[self.of.unit];
        Ok(unit.entry(self.of.at).map_err(bad)?.tag())
    }

    pub(crate) fn size(self) -> Result<u32, Fault> {
        if self.tag()? == DW_TAG_array_type {
            let (stride, length) = (self.element(0)?.size()?, self.length()?);
            return Ok(stride * length);
        }
        let unit = &self.info.units[self.of.unit];
        let entry = unit.entry(self.of.at).map_err(bad)?;
        let size = number(&entry, DW_AT_byte_size)?;
        let size = size.map(|size| size as u32);
        size.ok_or_else(|| bad("a type without a size"))
    }

    pub(crate) fn length(self) -> Result<u32, Fault> {
        let mut children = self.info.children(self.of)?.into_iter();
        let length = children.find_map(|child| child.length);
        length.ok_or_else(|| bad("an array without a length"))
    }

    pub(crate) fn element(self, index: u32) -> Result<Self, Fault> {
        if self.tag()? != DW_TAG_array_type {
            return self.inner("not an array")?.element(index);
        }
        let unit = &self.info.units[self.of.unit];
        let entry = unit.entry(self.of.at).map_err(bad)?;
        let of = self.info.type_of(self.of.unit, &entry)?;
        let first = self.part(0, of.ok_or_else(|| bad("an array of nothing"))?);
        let stride = first.size()?;
        Ok(first.part(index * stride, first.of))
    }

    /// What kind of number it is; structures around a single number are seen through.
    pub(crate) fn scalar(self) -> Result<(u32, Number), Fault> {
        match self.tag()? {
            tag if tag == DW_TAG_base_type => {
                let unit = &self.info.units[self.of.unit];
                let entry = unit.entry(self.of.at).map_err(bad)?;
                let encoding = entry.attr_value(DW_AT_encoding).map_err(bad)?;
                let float = encoding == Some(AttributeValue::Encoding(DW_ATE_float));
                match (self.size()?, float) {
                    (4, true) => Ok((self.address, Number::Single)),
                    (4, false) => Ok((self.address, Number::Word)),
                    _ => Err(bad("not a number of four bytes")),
                }
            }
            tag if tag == DW_TAG_structure_type || tag == DW_TAG_union_type => {
                self.inner("not a number")?.scalar()
            }
            _ => Err(bad("not a number")),
        }
    }

    /// The variant of that name of an enum: its tag's place and value, and what it holds.
    pub(crate) fn variant(self, name: &str) -> Result<(u32, u8, Self), Fault> {
        let (tag, value, held) = self.any_variant(name)?;
        let value = value.ok_or_else(|| bad(format!("variant {name} has no tag")))?;
        Ok((tag, value as u8, held))
    }

    /// What the variant of that name holds, whatever its tag.
    pub(crate) fn held(self, name: &str) -> Result<Self, Fault> {
        self.any_variant(name).map(|(_, _, held)| held)
    }

    fn any_variant(self, name: &str) -> Result<(u32, Option<u64>, Self), Fault> {
        if let Some(found) = self.own_variant(name)? {
            return Ok(found);
        }
        let inner = self.inner(format_args!("no variant {name}"))?;
        inner.any_variant(name)
    }

    /// Of itself; a variant that is every other tag has no value of its own.
    fn own_variant(self, name: &str) -> Result<Option<(u32, Option<u64>, Self)>, Fault> {
        let mut children = self.info.children(self.of)?.into_iter();
        let Some(part) = children.find(|child| child.tag == DW_TAG_variant_part) else {
            return Ok(None);
        };
        let parts = self.info.children(part.at)?;
        let tag = parts.iter().find(|part| part.tag == DW_TAG_member);
        let tag = tag.and_then(|tag| tag.offset).unwrap_or(0);
        for variant in parts.iter().filter(|part| part.tag == DW_TAG_variant) {
            if let Some((offset, of)) = self.info.member(variant.at, name)? {
                let held = self.part(offset, of);
                return Ok(Some((self.address + tag, variant.value, held)));
            }
        }
        Ok(None)
    }
}
