//! The commands, one file for each.

pub(crate) mod capture;
pub(crate) mod log;
pub(crate) mod monitor;
pub(crate) mod records;
