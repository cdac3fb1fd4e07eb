//! What the command line can do, one file a command.

pub mod classify;
pub mod experiment;
pub mod main_job;
pub mod merge;
pub mod record;
pub mod report;
pub mod run;
pub mod train;
