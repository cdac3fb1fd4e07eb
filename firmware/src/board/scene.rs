//! The scene that the firmware was built for, as constants and types; written
//! by the build script from the scene file.
//!
//! - `NAME`, `TICK_HZ`, `CONTACT`: of every scene.
//! - `Number`: the number format of the tick.
//! - `Moving`: how it moves, a [`Moves`](super::motion::Moves).
//! - `Deciding`: what it decides, a [`Decides`](super::touch::Decides).
//! - `Scene`: carries the constants of what the scene names, as
//!   [`Whisking`](super::motion::Whisking) and
//!   [`Classifies`](super::touch::Classifies).
#![allow(
    clippy::enum_glob_use,
    clippy::wildcard_imports,
    reason = "variants print with the names of the types they hold; a glob gives way to those"
)]
#![allow(
    clippy::excessive_precision,
    clippy::unreadable_literal,
    reason = "numbers are written as computed"
)]

include!(concat!(env!("OUT_DIR"), "/scene.rs"));
