//! What a probe reads from RAM and writes into it: RTT's rings, of which the first is the log,
//! decoded by defmt. RAM is that of a chip behind a probe, or of one that is emulated.
//!
//! # Glossary
//!
//! - *control block*: what lists the rings, at a place that the program's file names;
//! - *ring*: a buffer with the offsets of its writer and its reader; *up* comes from the
//!   module, *down* goes to it;
//! - *packets*, *requests*: those of the crate `wire`.

mod block;
mod log;
mod program;
mod ring;

pub use block::Rtt;
pub use log::LogDecoder;
pub use program::{BadProgram, symbol};
pub use ring::{Ram, Ring};
