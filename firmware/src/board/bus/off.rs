//! The bus of a program that has none: nothing.

use firmware::Event;

use crate::board::scene::Pace;
use crate::board::types::{Inner, Settings};

/// One board has all whiskers.
pub(crate) const fn number(_: &Settings) -> u8 {
    0
}

pub(crate) struct Head;

impl Head {
    pub(crate) fn start(_: &Settings, _: &Pace, _: u8) -> Self {
        Self
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
