//! Telemetry of a program that leaves it out: nothing.

use firmware::{ConfigError, Event, ModelState};
use wire::{Answer, Load, TaggedCommand};

use crate::board::scene::Deployed;
use crate::board::types::{Inner, Number, Settings};

/// Nothing goes from idle to the tick.
pub(crate) struct Queue;

impl Queue {
    pub(crate) const fn new() -> Self {
        Self
    }

    pub(crate) fn split(&'static mut self) -> ((), ()) {
        ((), ())
    }
}

/// Nothing is asked about configurations.
pub(crate) struct Configs;

impl Configs {
    pub(crate) fn start(
        _: Result<Deployed, ConfigError>,
        _: Option<Number>,
        _: (),
    ) -> Option<Self> {
        Some(Self)
    }

    pub(crate) fn tell(&mut self, _: u32) {}
}

/// There is nothing to hear.
pub(crate) fn hear(_: &mut Configs) {}

/// There is nothing to load.
pub(crate) fn to_load() -> Option<(Load, Answer, bool)> {
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

/// No event is noted.
#[inline]
pub(crate) fn note(_: &Event) {}

/// No link.
pub(crate) struct Telemetry;

impl Telemetry {
    pub(crate) fn new(_: &Settings, _: &Inner, _: ModelState, _: ()) -> Self {
        Self
    }

    pub(crate) fn send(&mut self, _: &Inner, _: &Settings, _: u32) {}

    pub(crate) fn talk(&mut self, _: &mut Inner, _: &Settings, _: u32) {}
}
