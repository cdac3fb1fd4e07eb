//! What the program's file says: where its symbols are.

use object::{Object, ObjectSymbol};

/// A program's file that is not what it should be.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct BadProgram(pub(crate) String);

/// The address of a symbol in the ELF file `elf`.
///
/// # Errors
/// [`BadProgram`] if it is no such file, or has no such symbol.
pub fn symbol(elf: &[u8], name: &str) -> Result<u32, BadProgram> {
    let file = object::File::parse(elf).map_err(|error| BadProgram(error.to_string()))?;
    let symbol = file.symbols().find(|symbol| symbol.name() == Ok(name));
    let symbol = symbol.ok_or_else(|| BadProgram(format!("it has no symbol {name}")))?;
    Ok(symbol.address() as u32)
}
