//! Telemetry of a scene that leaves it out: nothing.

use firmware::{Event, ModelState};
use wire::{Answer, TaggedCommand};

use crate::board::inner::Inner;
use crate::board::scene::{Perception, Settings};

/// There is nothing to hear.
pub(crate) fn hear() {}

/// There is nothing to load.
pub(crate) fn to_load() -> Option<(Answer, bool)> {
    None
}

/// Nobody asks.
pub(crate) struct ProbeLine;

impl ProbeLine {
    pub(crate) const fn new() -> Self {
        Self
    }

    pub(crate) fn next(&mut self) -> Option<TaggedCommand> {
        None
    }

    pub(crate) fn reply(&mut self, _: &Answer) {}

    pub(crate) fn has_sent(&self) -> bool {
        true
    }
}

/// There is nothing to do.
#[inline]
pub(crate) fn is_busy() -> bool {
    false
}

/// Nothing waits.
#[inline]
pub(crate) fn waits() -> bool {
    false
}

/// Nobody is told of an event.
#[inline]
pub(crate) fn note(_: &Event) {}

/// Nothing is told.
pub(crate) struct Telemetry;

impl Telemetry {
    pub(crate) const fn new(_: &Settings, _: &Perception, _: ModelState) -> Self {
        Self
    }

    pub(crate) fn send(&mut self, _: &Inner, _: &Settings, _: u32) {}

    pub(crate) fn talk(&mut self, _: &mut Inner, _: &mut Settings, _: u32) {}
}

/// Nothing changes settings.
pub(crate) struct Tuned;

impl Tuned {
    pub(crate) const fn new() -> Self {
        Self
    }

    pub(crate) fn tell(&mut self, _: u32) {}
}
