//! The window in which one watches a module.

mod draw;
mod faults;
mod hearing;
mod history;
mod known;
mod listener;
mod save;
mod screen;
mod shown;
mod snapshot;
mod svg;
mod view;
mod window;

pub(crate) use faults::number;
pub(crate) use hearing::{Hearing, Shared, Wish};
pub(crate) use history::History;
pub(crate) use known::Known;
pub(crate) use listener::Listener;
pub(crate) use snapshot::{Size, Snapshot, size};
pub(crate) use window::{About, open};
