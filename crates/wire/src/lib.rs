//! What a whisker module and a PC say to each other.
//!
//! Upwards go [packets](Packet) of [`PACKET_WORDS`] words of 32 bits: a [`TickRecord`] of each
//! whisker after every tick, once that is asked for, and [answers](Answer). Downwards go
//! [requests](TaggedCommand) of [`REQUEST_WORDS`] words. Words are little-endian.
//!
//! A serial line carries both as [frames](Framed) between lines of text, and commands as
//! [text] too.
//!
//! # Glossary
//!
//! - *sequence*: the number of the tick since the module started; wraps around. Records
//!   that are missing between two were lost.
//! - *protraction*: θ, without unit; the whisker's angle is 100 θ + 50 degrees.
//! - *Q13, Q15, Q24*: integers that stand for n/2^13, n/32767 and n/2^24.
#![cfg_attr(not(test), no_std)]

mod answer;
mod flags;
mod framed;
mod line;
mod loading;
mod packet;
mod record;
mod request;
mod splitter;
pub mod text;
mod words;

pub use answer::{Answer, CommandStatus};
pub use flags::Flags;
pub use framed::{Framed, PACKET_FRAME_BYTES, REQUEST_FRAME_BYTES};
pub use line::{LINE_BYTES, Line};
pub use loading::{Load, LoadedWord};
pub use packet::Packet;
pub use record::{TickRecord, degrees, q13, unit};
pub use request::{
    CONFIG_CHANGED, Command, REQUEST_BYTES, REQUEST_WORDS, TaggedCommand, UnknownCommand,
    WhiskerId, summed,
};
pub use splitter::{Garbled, Piece, Splitter};
pub use words::{PACKET_BYTES, PACKET_WORDS};
