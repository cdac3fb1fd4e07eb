//! A DMA controller, which moves single bytes on request. There are two kinds, a file each.

mod channels;
mod moved;
mod streams;

pub(super) use moved::Move;

use super::fields::Field;
use channels::Channels;
use streams::Streams;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Version {
    Streams,
    /// Channels, whose requests are wired, or selected by a DMAMUX.
    Channels,
}

pub(super) const fn fields(version: Version) -> &'static [Field] {
    match version {
        Version::Streams => &streams::FIELDS,
        Version::Channels => &channels::FIELDS,
    }
}

#[derive(Debug, Clone)]
pub(super) enum Dma {
    Streams(Streams),
    Channels(Channels),
}

impl Dma {
    pub(super) fn new(version: Version) -> Self {
        match version {
            Version::Streams => Self::Streams(Streams::default()),
            Version::Channels => Self::Channels(Channels::default()),
        }
    }

    pub(super) fn reset(&mut self) {
        *self = match self {
            Self::Streams(_) => Self::new(Version::Streams),
            Self::Channels(_) => Self::new(Version::Channels),
        };
    }

    pub(super) fn stop(&mut self, stream: usize) {
        match self {
            Self::Streams(streams) => streams.stop(stream),
            Self::Channels(channels) => channels.stop(stream),
        }
    }

    /// Serves a request on a stream or channel, counted from 0: the byte to move, if it
    /// listens. A stream listens to the one `selected` alone.
    pub(super) fn request(&mut self, stream: usize, selected: u32) -> Option<Move> {
        match self {
            Self::Streams(streams) => streams.request(stream, selected),
            Self::Channels(channels) => channels.request(stream),
        }
    }

    pub(super) fn interrupts(&self, stream: usize) -> bool {
        match self {
            Self::Streams(streams) => streams.interrupts(stream),
            Self::Channels(channels) => channels.interrupts(stream),
        }
    }

    pub(super) fn read(&self, offset: u32) -> Option<u32> {
        match self {
            Self::Streams(streams) => streams.read(offset),
            Self::Channels(channels) => channels.read(offset),
        }
    }

    pub(super) fn write(&mut self, offset: u32, value: u32) -> bool {
        match self {
            Self::Streams(streams) => streams.write(offset, value),
            Self::Channels(channels) => channels.write(offset, value),
        }
    }
}
