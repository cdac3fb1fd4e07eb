//! `[head]`: the array of whiskers.

use crate::choice::choice;
use crate::key::{Condition, integer, word};
use crate::keys::keys;

choice! {
    /// Which sides of the head are built.
    pub enum Sides {
        /// Left and right.
        Both = "both",
        /// Only the left half of the array.
        Left = "left",
    }
}

impl Sides {
    /// How many sides are built: 2 or 1.
    pub const fn count(self) -> usize {
        match self {
            Self::Both => 2,
            Self::Left => 1,
        }
    }
}

const BUS: &[Condition] = &[Condition::Given("nodes")];

keys! {
    /// The array of whiskers.
    pub struct HeadSection {
        /// Whiskers on each side.
        whiskers_per_side: usize = integer(1..=12),

        /// Rows of a side, for pictures: its whiskers stand row by row, each row from front to back.
        rows: usize = integer(1..=12).default("1"),

        /// Which sides are built; with `left`, lists that have one entry a side have one entry.
        sides: Sides = word().default("\"both\""),

        /// Boards that share the whiskers, joined by [a CAN bus](head.md): each carries as many as
        /// any other, node 0 the first of the left side.
        nodes: Option<u8> = integer(2..=24).unit("boards").optional("one board has all whiskers"),

        /// Speed of the bus.
        bus_kbit_s: Option<u16> = integer(125..=1000)
            .unit("kbit/s")
            .only_if(BUS)
            .optional("1000 with `nodes`"),
    }
}
