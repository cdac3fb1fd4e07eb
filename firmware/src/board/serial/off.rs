//! The serial port of a program that has none: nothing.

use firmware::{Event, NotArmed, StartCause, Startup};
use wire::{Answer, TaggedCommand};

use crate::board::about::About;
use crate::board::log::Health;
use crate::board::perception::Names;
use crate::board::telemetry::Configs;

/// There is no line.
pub(crate) fn started(_: StartCause, _: &Startup, _: &About) {}

/// There is no line.
pub(crate) fn not_armed(_: NotArmed, _: &About) {}

/// No port.
pub(crate) struct Serial;

impl Serial {
    pub(crate) fn start(_: &About) -> Option<Self> {
        None
    }

    pub(crate) fn tell(&mut self, _: &Event, _: &Names) {}

    pub(crate) fn armed(&mut self) {}

    pub(crate) fn health(&mut self, _: &Health, _: &Health) {}

    pub(crate) fn serve(&mut self, _: u32, _: &About, _: &mut Configs) {}

    pub(crate) fn next(&mut self) -> Option<TaggedCommand> {
        None
    }

    pub(crate) fn reply(&mut self, _: &Answer) {}

    pub(crate) fn has_sent(&mut self) -> bool {
        true
    }
}
