//! The window in which one watches a module.

mod draw;
mod history;
mod listener;
mod looking;
mod save;
mod shown;
mod svg;
mod view;
mod watching;
mod window;

pub(crate) use history::History;
pub(crate) use listener::{Known, Listener};
pub(crate) use looking::Looking;
pub(crate) use shown::Shown;
pub(crate) use svg::{Size, drawn, size, svg, text};
pub(crate) use watching::{Shared, Watching, Wish, joined, lock};
pub(crate) use window::{About, open};
