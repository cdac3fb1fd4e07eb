//! What a PC needs to work with a board: what was found, and what of it is missing.

mod checks;
mod facts;

pub(crate) use checks::{Purpose, checks};
pub(crate) use facts::Facts;
