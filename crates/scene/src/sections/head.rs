//! `[head]`: the array of whiskers.

use crate::choice::choice;
use crate::key::{integer, word};
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

keys! {
    /// The array of whiskers.
    pub struct HeadSection {
        /// Whiskers on each side.
        whiskers_per_side: usize = integer(1..=12),

        /// Which sides are built; with `left`, lists that have one entry a side have one entry.
        sides: Sides = word().default("\"both\""),
    }
}
