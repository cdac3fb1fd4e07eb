//! All numbers in RAM, by the names of the variables and members that lead to them.

use gimli::{
    DW_TAG_array_type, DW_TAG_member, DW_TAG_structure_type, DW_TAG_union_type, DW_TAG_variant,
    DW_TAG_variant_part,
};

use super::{DebugInfo, Place, Type};
use crate::chip::Fault;
use crate::memory::RAM;

#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Leaf {
    pub(crate) address: u32,
    pub(crate) size: u32,
    /// Its variable, members and indices, without what cells, lists and RTIC put around them.
    pub(crate) path: String,
}

/// Parts of names that only wrap another.
const AROUND: [&str; 9] = [
    "__0", "value", "inner", "buffer", "uninit", "__1", "val", "Some", "Ok",
];

fn short(path: &str) -> String {
    let path = ["shared_resource_", "local_init_", "local_resource_"]
        .into_iter()
        .find_map(|prefix| path.strip_prefix("__rtic_internal_")?.strip_prefix(prefix))
        .unwrap_or(path);
    let mut parts = Vec::new();
    for part in path.split('.') {
        let (name, index) = part.split_once('[').unwrap_or((part, ""));
        match parts.last_mut() {
            // An element of a list is called after the list.
            Some(last) if AROUND.contains(&name) && !index.is_empty() => {
                *last = format!("{last}[{index}");
            }
            _ if AROUND.contains(&name) => {}
            _ => parts.push(part.to_owned()),
        }
    }
    parts.join(".")
}

impl DebugInfo {
    pub(crate) fn leaves(&self) -> Result<Vec<Leaf>, Fault> {
        let mut leaves = Vec::new();
        self.variables::<()>(|name, place| {
            if place.address >= RAM {
                place.leaves(&name, &mut leaves)?;
            }
            Ok(None)
        })?;
        Ok(leaves)
    }
}

impl Place<'_> {
    fn leaves(self, path: &str, into: &mut Vec<Leaf>) -> Result<(), Fault> {
        let tag = self.tag()?;
        if tag == DW_TAG_array_type {
            for n in 0..self.length()? {
                self.element(n)?.leaves(&format!("{path}[{n}]"), into)?;
            }
            return Ok(());
        }
        if tag == DW_TAG_structure_type || tag == DW_TAG_union_type {
            return self.members(self.of, path, into);
        }
        let size = self.size().unwrap_or(4);
        into.push(Leaf {
            address: self.address,
            size,
            path: short(path),
        });
        Ok(())
    }

    /// The numbers in the members directly below `of`, and in those of every variant.
    fn members(self, of: Type, path: &str, into: &mut Vec<Leaf>) -> Result<(), Fault> {
        for child in self.info.children(of)? {
            if child.tag == DW_TAG_variant_part || child.tag == DW_TAG_variant {
                self.members(child.at, path, into)?;
            } else if child.tag == DW_TAG_member
                && let Some(of) = child.of
            {
                // The tag of a variant has no name.
                let name = child.name.as_deref().unwrap_or("tag");
                let part = self.part(child.offset.unwrap_or(0), of);
                part.leaves(&format!("{path}.{name}"), into)?;
            }
        }
        Ok(())
    }
}
