//! The commands, one file for each.

#[cfg(unix)]
pub(crate) mod board;
pub(crate) mod bringup;
pub(crate) mod calibrate;
pub(crate) mod capture;
pub(crate) mod check;
pub(crate) mod deploy;
pub(crate) mod doctor;
pub(crate) mod flash;
pub(crate) mod log;
pub(crate) mod monitor;
pub(crate) mod order;
pub(crate) mod records;
pub(crate) mod tuning;
