//! The commands of the command line, one file for each.

pub mod classify;
pub mod main_job;
pub mod record;
pub mod run;
pub mod train;
