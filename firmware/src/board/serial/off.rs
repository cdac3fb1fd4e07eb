//! The serial port of a program that has none: nothing.

use firmware::{Event, NotArmed, StartCause, Startup};
use wire::{Answer, Frame, Request};

use crate::board::about::About;
use crate::board::perception::Names;
use crate::board::telemetry::Exchange;

pub(crate) fn started(_: StartCause, _: &Startup, _: &About) {}

pub(crate) fn not_armed(_: NotArmed, _: &About) {}

pub(crate) fn lost() -> u32 {
    0
}

pub(crate) fn send_event(_: &Frame) {}

pub(crate) fn send_record(_: &Frame) -> bool {
    false
}

pub(crate) struct Serial;

impl Serial {
    pub(crate) fn start(_: &About) -> Option<Self> {
        None
    }

    pub(crate) fn say(&mut self, _: &Event, _: &Names) {}

    pub(crate) fn serve(&mut self, _: u32, _: &About, _: (&mut Exchange, &Names)) {}

    pub(crate) fn send(&mut self) {}

    pub(crate) fn next(&mut self) -> Option<Request> {
        None
    }

    pub(crate) fn reply(&mut self, _: &Answer) {}

    pub(crate) fn has_sent(&mut self) -> bool {
        true
    }
}
