//! The window in which one watches a module.

mod draw;
mod history;
mod known;
mod listener;
mod looking;
mod save;
mod shown;
mod snapshot;
mod svg;
mod view;
mod watching;
mod window;

pub(crate) use history::History;
pub(crate) use known::Known;
pub(crate) use listener::Listener;
pub(crate) use looking::Looking;
pub(crate) use snapshot::{Size, size, snapshot};
pub(crate) use svg::{svg, text};
pub(crate) use watching::{Shared, Watching, Wish, joined};
pub(crate) use window::{About, open};
