//! The link of a program that has none: nothing.

use firmware::{Event, EventRecord, ModelState};

use crate::board::about::About;
use crate::board::bus::Post;
use crate::board::perception::Names;
use crate::board::scene::Deployed;
use crate::board::types::{Inner, Number, Settings};

pub(crate) struct Queues;

pub(crate) struct Ends;

impl Queues {
    pub(crate) const fn new() -> Self {
        Self
    }

    pub(crate) fn split(&'static mut self) -> (Ends, (), Ends) {
        (Ends, (), Ends)
    }
}

pub(crate) struct Configs;

impl Configs {
    pub(crate) fn start(
        _: Result<Deployed, firmware::ConfigError>,
        _: Option<Number>,
        _: (),
    ) -> Option<Self> {
        Some(Self)
    }
}

pub(crate) struct Exchange;

impl Exchange {
    pub(crate) fn new(_: Ends, _: Configs, _: Post, _: &About) -> Self {
        Self
    }

    pub(crate) fn log_changes(&mut self, _: u32) {}

    pub(crate) fn take_from_probe(&mut self, _: &Names) {}

    pub(crate) fn take_from_head(&mut self, _: &Names) {}

    pub(crate) fn answer_probe(&mut self) {}

    pub(crate) fn answer_head(&mut self) {}

    pub(crate) fn send_event(&mut self, _: EventRecord) {}

    pub(crate) fn send_records(&mut self) {}
}

pub(crate) struct Telemetry;

impl Telemetry {
    pub(crate) fn new(_: &Settings, _: &Inner, _: ModelState, _: Ends) -> Self {
        Self
    }

    #[inline]
    pub(crate) fn look_for_stop(&mut self, _: u32) -> bool {
        false
    }

    pub(crate) fn stop(&mut self) {}

    pub(crate) fn note(&mut self, _: &Event) {}

    #[inline]
    pub(crate) fn is_busy(&self) -> bool {
        false
    }

    #[inline]
    pub(crate) fn waits(&self) -> bool {
        false
    }

    pub(crate) fn send(&mut self, _: &Inner, _: &Settings, _: u32) {}

    pub(crate) fn talk(&mut self, _: &mut Inner, _: &Settings, _: u32) -> bool {
        false
    }
}
