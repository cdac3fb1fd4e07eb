//! The bus of a program that has none: nothing.

use firmware::{Event, Heard, Packet};
use wire::{Answer, ForNode, TaggedCommand, UnknownCommand};

use crate::board::scene::Pace;
use crate::board::types::{Inner, Settings};

pub(crate) const fn number(_: &Settings) -> u8 {
    0
}

pub(crate) struct Head;

pub(crate) struct Post;

pub(crate) fn say_stop(_: Option<u8>) {}

impl Post {
    pub(crate) const fn number(&self) -> Option<u8> {
        None
    }

    pub(crate) const fn has(&self, _: u8) -> bool {
        false
    }

    pub(crate) fn ask(&mut self, _: ForNode) -> bool {
        false
    }

    pub(crate) fn next(&mut self) -> Option<Heard> {
        None
    }

    pub(crate) fn take_request(&mut self) -> Option<(u8, Result<TaggedCommand, UnknownCommand>)> {
        None
    }

    pub(crate) fn answer(&mut self, _: &Answer) -> bool {
        true
    }

    pub(crate) fn packet(&mut self, _: u8, _: &Packet) {}

    pub(crate) fn every(&self) -> u32 {
        1
    }

    pub(crate) fn begin_loading(&mut self) {}

    pub(crate) fn next_alone(&mut self) -> Option<TaggedCommand> {
        None
    }

    pub(crate) fn reply_alone(&mut self, _: &Answer) {}

    pub(crate) fn has_sent() -> bool {
        true
    }
}

impl Head {
    pub(crate) fn start(_: &Settings, _: &Pace, _: u8) -> (Self, Post) {
        (Self, Post)
    }

    #[inline]
    pub(crate) fn before(&mut self, _: &mut Inner, _: &Settings, _: &mut impl FnMut(Event)) {}

    #[inline]
    pub(crate) fn note(&mut self, _: &Event) {}

    #[inline]
    pub(crate) fn after(&mut self, _: &Inner, _: &Settings) {}

    #[inline]
    pub(crate) fn stop(&mut self) {}

    #[inline]
    pub(crate) fn arm(&mut self) {}
}
