//! What lies where in a board's flash.

use super::{MARK_WORDS, SLOT_HEADER_BYTES};

/// Bytes of flash from an address on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Region {
    /// The address of the first.
    pub start: u32,
    /// How many there are.
    pub bytes: u32,
}

impl Region {
    pub(super) const fn new(start: u32, bytes: u32) -> Self {
        Self { start, bytes }
    }

    /// The address behind the last.
    pub const fn end(self) -> u32 {
        self.start + self.bytes
    }

    /// Whether all of `other` lies in it.
    pub const fn contains(self, other: Self) -> bool {
        self.start <= other.start && other.end() <= self.end()
    }

    /// Words that there is room for.
    pub const fn words(self) -> u32 {
        self.bytes / 4
    }
}

/// Where a scene and its model are deployed to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Slot {
    /// What is erased for it: whole sectors or pages.
    pub erased: Region,
    /// Its header, and the configuration behind it.
    pub head: Region,
    /// The model. It may lie in flash of its own, which is another slot's too.
    pub model: Region,
}

impl Slot {
    /// A sector with a model of its own.
    pub(super) const fn sector(sector: Region) -> Self {
        Self {
            erased: sector,
            head: Region::new(sector.start, MODEL_OFFSET),
            model: Region::new(sector.start + MODEL_OFFSET, sector.bytes - MODEL_OFFSET),
        }
    }

    /// Pages whose model lies apart.
    pub(super) const fn pages(pages: Region, model: Region) -> Self {
        Self {
            erased: pages,
            head: pages,
            model,
        }
    }

    /// Where the configuration begins.
    pub const fn config(self) -> Region {
        let header = SLOT_HEADER_BYTES as u32;
        Region::new(self.head.start + header, self.head.bytes - header)
    }

    /// Where the mark is, between header and configuration.
    pub const fn mark(self) -> Region {
        let bytes = (MARK_WORDS * size_of::<u32>()) as u32;
        Region::new(self.config().start - bytes, bytes)
    }

    /// Whether the model is erased with the rest.
    pub const fn has_model(self) -> bool {
        self.erased.contains(self.model)
    }
}

/// A board's flash.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FlashMap {
    /// For the program.
    pub program: Region,
    /// For scenes.
    pub slots: [Slot; 2],
}

/// From the start of a slot that has a model of its own to that.
pub(super) const MODEL_OFFSET: u32 = 4096;
