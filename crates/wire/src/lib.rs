//! What a whisker module and a PC say to each other.
//!
//! Upwards go packets: a [`TickRecord`] of each whisker after every tick, once that is asked for,
//! what happens in between, and [answers](Answer). Downwards go [requests](TaggedCommand). Both
//! are [frames](frame()), on a probe's rings as on a serial line, which carries them between lines
//! of text, and commands as [text] too.
//!
//! # Glossary
//!
//! - *sequence*: the number of the tick since the module started; wraps around. Records
//!   that are missing between two were lost.
//! - *protraction*: θ, without unit; the whisker's angle is 100 θ + 50 degrees.
//! - *Q13, Q15, Q24*: integers that stand for n/2^13, n/32767 and n/2^24.
#![cfg_attr(not(test), no_std)]

mod answer;
mod asked;
mod flags;
mod frame;
mod line;
mod loading;
mod looked;
mod reader;
mod record;
mod request;
mod splitter;
mod stop;
pub mod text;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

pub use answer::{Answer, CommandStatus};
pub use asked::{COMMAND_MOST, ForNode, Request, frame_for};
pub use flags::Flags;
pub use frame::{
    CONTENT_BYTES, FRAME_BYTES, Frame, RECORD_FRAME_BYTES, crc32, frame, frame_of, open,
};
pub use line::{Field, LINE_BYTES, Line};
pub use loading::{Load, LoadedWord};
pub use looked::Looked;
pub use reader::{Reader, Unreadable};
pub use record::{TickRecord, degrees, q13, unit};
pub use request::{
    CONFIG_CHANGED, Command, HAS_OPINIONS, TaggedCommand, UnknownCommand, WhiskerId,
};
pub use splitter::{Garbled, Piece, Splitter};
pub use stop::{COMMAND_BYTES, Stop, StopWatch};
