//! The whisker module on a PC: the firmware library runs unchanged on a mock
//! SPI bus and a mock motor, with whisker and surface behind them.

pub mod bench;
pub mod bus;
pub mod classifier;
pub mod commands;
pub mod decisions;
pub mod drive;
mod error;
pub mod motor;
pub mod output;
pub mod plant;
pub mod plot;
pub mod progress;
pub mod recording;
pub mod report;
pub mod run;
pub mod trace;
pub mod world;

pub use error::Error;
