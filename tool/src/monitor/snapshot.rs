//! The window without a terminal.

use std::convert::Infallible;
use std::sync::Mutex;

use host_sim::Error;
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::buffer::Buffer;

use super::draw::{Theme, draw};
use super::shown::Shown;
use super::watching::{Shared, lock};
use super::window::About;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Size {
    columns: u16,
    rows: u16,
}

pub(crate) fn size(text: &str) -> Result<Size, String> {
    let parts = text.split_once('x');
    let parts = parts.and_then(|(columns, rows)| Some((columns.parse().ok()?, rows.parse().ok()?)));
    let fits =
        |(columns, rows): &(u16, u16)| (10..=400).contains(columns) && (3..=200).contains(rows);
    let (columns, rows) = parts
        .filter(fits)
        .ok_or_else(|| "allowed: 10x3 to 400x200, as in 100x30".to_owned())?;
    Ok(Size { columns, rows })
}

/// The window's cells before a key is pressed.
pub(crate) fn snapshot(shared: &Mutex<Shared>, about: &About, size: Size) -> Result<Buffer, Error> {
    let shown = Shown::first(&lock(shared).history, &about.title);
    drawn(&shown, Theme::of_environment(), size.columns, size.rows)
}

pub(super) fn drawn(shown: &Shown, theme: Theme, columns: u16, rows: u16) -> Result<Buffer, Error> {
    let failed = |error: Infallible| Error::Work(error.to_string());
    let mut terminal = Terminal::new(TestBackend::new(columns, rows)).map_err(failed)?;
    let done = terminal.draw(|frame| draw(frame, shown, theme));
    done.map_err(failed)?;
    Ok(terminal.backend().buffer().clone())
}
