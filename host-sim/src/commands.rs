//! What the command line can do, one file a command.

pub mod classify;
pub mod main_job;
pub mod record;
pub mod run;
pub mod train;
