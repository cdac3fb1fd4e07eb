//! The board's own program, unchanged, on an emulated chip.
//!
//! # Glossary
//!
//! - *core*: an emulated Cortex-M with its NVIC (rsemu);
//! - *chip*: the peripherals around it, modelled here register by register;
//! - *model*: what tells one chip from another;
//! - *machine*: core, memories and chip in one time;
//! - *board*: the machine with host-sim's sensors, motors and plant on its pins;
//! - *watch*: the module's variables, read from RAM by their names in the
//!   debug information, as a debugger does.
//!
//! What runs is the ELF file that is flashed. `docs/boards.md` says what is
//! modelled and what is not.

mod board;
pub mod campaign;
mod chip;
mod commands;
mod compare;
mod core;
mod cost;
mod counters;
mod counts;
mod damaged;
mod deadlines;
mod debug_info;
mod deploying;
mod deployment;
mod emulate;
mod endurance;
pub mod head;
mod latency;
mod machine;
mod memory;
mod meter;
mod notice;
mod picture;
mod program;
mod registers;
mod scenario;
mod serial;
pub mod session;
mod stopping;
mod talk;
mod telemetry;
mod trial;
mod tuning;
mod upset;
mod watch;
mod wired;

pub use commands::main;
