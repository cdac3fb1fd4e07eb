//! A DMA controller, which moves single bytes on request. There are two kinds, a file each.

mod channels;
mod streams;

use std::fmt::Debug;

use super::fields::Field;
use channels::Channels;
use streams::Streams;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Version {
    Streams,
    /// Channels, whose requests are wired, or selected by a DMAMUX.
    Channels,
}

impl Version {
    /// As it is after a reset.
    pub(super) fn controller(self) -> Box<dyn Dma> {
        match self {
            Self::Streams => Box::<Streams>::default(),
            Self::Channels => Box::<Channels>::default(),
        }
    }

    pub(super) const fn fields(self) -> &'static [Field] {
        match self {
            Self::Streams => &streams::FIELDS,
            Self::Channels => &channels::FIELDS,
        }
    }
}

/// What a controller moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Move {
    pub(super) peripheral: u32,
    pub(super) memory: u32,
    pub(super) to_memory: bool,
}

/// Streams and channels are counted from 0.
pub(super) trait Dma: Debug + Send {
    fn stop(&mut self, stream: usize);

    /// Serves a request: the byte to move, if it listens. A stream listens to the one `selected`
    /// alone.
    fn request(&mut self, stream: usize, selected: u32) -> Option<Move>;

    fn interrupts(&self, stream: usize) -> bool;

    fn read(&self, offset: u32) -> Option<u32>;

    fn write(&mut self, offset: u32, value: u32) -> bool;
}
