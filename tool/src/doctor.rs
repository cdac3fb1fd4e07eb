//! What a PC needs to work with a board: what was found, and what of it is missing.

mod checks;
mod facts;
mod usb;

pub(crate) use checks::{Purpose, checks, is_well};
pub(crate) use facts::Facts;
