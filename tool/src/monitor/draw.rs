//! The window: what is shown, as characters. Colour alone carries no information.

mod charts;
mod hairs;
mod panes;

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::Line;
use ratatui::widgets::{Block, Clear, Paragraph};

use super::shown::Shown;
use super::view::KEYS;

/// A window this narrow, or low, has no room for the panes beside the charts, or for charts.
const WIDE: u16 = 68;
const HIGH: u16 = 14;

/// Where head, states, charts, the panes beside them, and foot are.
fn places(area: Rect, whiskers: u16) -> [Rect; 5] {
    let [top, states, body, foot] = Layout::vertical([
        Constraint::Length(1),
        Constraint::Length(whiskers),
        Constraint::Min(0),
        Constraint::Length(1),
    ])
    .areas(area);
    let side = match (area.width >= WIDE, area.height >= HIGH) {
        (true, _) => (body.width * 2 / 5).clamp(34, 60),
        // Charts alone, or the panes alone.
        (false, true) => 0,
        (false, false) => body.width,
    };
    let [charts, side] =
        Layout::horizontal([Constraint::Min(0), Constraint::Length(side)]).areas(body);
    [top, states, charts, side, foot]
}

pub(crate) fn draw(frame: &mut Frame<'_>, shown: &Shown) {
    let area = frame.area();
    let [top, states, charts, side, foot] = places(area, shown.whiskers.len() as u16);
    frame.render_widget(head(shown, top.width), top);
    panes::states(frame, states, shown);
    if shown.hairs.is_empty() {
        charts::charts(frame, charts, shown);
    } else {
        hairs::hairs(frame, charts, &shown.hairs);
    }
    panes::panes(frame, side, shown);
    let line = if shown.message.is_empty() {
        "x stop  a arm  p pause  Tab side  +- time  s save  q end  ^C stop, end  ? help"
    } else {
        &shown.message
    };
    frame.render_widget(Line::from(line).style(bold()), foot);
    if shown.has_help {
        help(frame, area);
    }
    // As the environment asks for (<https://no-color.org>).
    if std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty()) {
        for cell in &mut frame.buffer_mut().content {
            cell.fg = Color::Reset;
        }
    }
}

fn bold() -> Style {
    Style::new().add_modifier(Modifier::BOLD)
}

fn head(shown: &Shown, width: u16) -> Line<'static> {
    let state = match shown.behind_s {
        Some(behind_s) => format!("PAUSED, {behind_s:.1} s behind"),
        None => "live".to_owned(),
    };
    let right = format!("{:.2} s  {state}", shown.to_s);
    let room = usize::from(width).saturating_sub(right.len() + 1);
    let title: String = shown.title.chars().take(room).collect();
    Line::from(format!("{title:room$} {right}"))
        .style(Style::new().add_modifier(Modifier::REVERSED))
}

fn help(frame: &mut Frame<'_>, area: Rect) {
    let lines = KEYS.map(|(key, does)| Line::from(format!(" {key:19} {does}")));
    let width = lines.iter().map(Line::width).max().unwrap_or(0) + 3;
    let width = (width as u16).min(area.width);
    let height = (KEYS.len() as u16 + 2).min(area.height);
    let place = Rect {
        x: area.x + (area.width - width) / 2,
        y: area.y + (area.height - height) / 2,
        width,
        height,
    };
    frame.render_widget(Clear, place);
    let keys = Paragraph::new(lines.to_vec()).block(Block::bordered().title(" keys "));
    frame.render_widget(keys, place);
}

#[cfg(test)]
mod tests;
