//! What the boards of one head say to each other over CAN 2.0: messages of at most eight bytes,
//! whose standard identifiers are what they say and who says it.
//!
//! # Glossary
//!
//! - *node*: a board of a head, with a number from 0.
//! - *stamp*: the low eight bits of the tick after which a message was made, counted by a clock
//!   that all nodes share.
//! - *Q15, Q22*: integers that stand for n/2^15 and n/2^22.
#![cfg_attr(not(test), no_std)]

mod frame;
mod letter;
mod message;

pub use frame::{Frame, MOST_BITS};
pub use letter::{Assembly, LETTER_BYTES, Letter, LetterKind, PARTS, Part};
pub use message::{Contact, Evidence, Message, NotAMessage, OTHERS, Q22_ONE};

/// Most nodes of a head: one for each of 24 whiskers.
pub const MAX_NODES: usize = 24;
