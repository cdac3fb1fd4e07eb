//! What a program holds, read from its ELF file.

pub(crate) mod calls;
pub(crate) mod contents;
mod thumb;
