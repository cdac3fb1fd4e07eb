//! The serial port of a scene that has none: nothing.

use firmware::{Event, NotArmed, StartCause, Startup};
use wire::{Answer, TaggedCommand};

use crate::board::log::Health;
use crate::board::scene::Names;

/// Nobody is told.
pub(crate) fn started(_: StartCause, _: &Startup) {}

/// Nobody is told.
pub(crate) fn not_armed(_: NotArmed) {}

/// No port.
pub(crate) struct Serial;

impl Serial {
    pub(crate) fn start() -> Self {
        Self
    }

    pub(crate) fn tell(&mut self, _: &Event, _: &Names) {}

    pub(crate) fn armed(&mut self) {}

    pub(crate) fn health(&mut self, _: &Health, _: &Health) {}

    pub(crate) fn serve(&mut self, _: u32) {}

    pub(crate) fn next(&mut self) -> Option<TaggedCommand> {
        None
    }

    pub(crate) fn reply(&mut self, _: &Answer) {}

    pub(crate) fn has_sent(&mut self) -> bool {
        true
    }
}
