//! The window without a terminal.

use std::convert::Infallible;
use std::sync::Mutex;

use host_sim::Error;
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::buffer::Buffer;

use super::draw::{Theme, draw};
use super::svg;
use super::view::View;
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

pub(crate) struct Snapshot(Buffer);

impl Snapshot {
    pub(crate) fn of(shared: &Mutex<Shared>, about: &About, size: Size) -> Result<Self, Error> {
        let shown = {
            let history = &lock(shared).history;
            let view = View::new(history.extent());
            history.shown(&view, &about.title, String::new())
        };
        let failed = |error: Infallible| Error::Work(error.to_string());
        let mut terminal =
            Terminal::new(TestBackend::new(size.columns, size.rows)).map_err(failed)?;
        let theme = Theme::of_environment();
        terminal
            .draw(|frame| draw(frame, &shown, theme))
            .map_err(failed)?;
        Ok(Self(terminal.backend().buffer().clone()))
    }

    pub(crate) fn text(&self) -> String {
        svg::text(&self.0)
    }

    pub(crate) fn svg(&self) -> String {
        svg::svg(&self.0)
    }
}
