//! The window without a terminal, as text and as a picture: from the buffer that one would get.
//!
//! Dots of Braille characters, bars and frames are drawn, as fonts have them in any shape or
//! not at all; the rest is text, a run of cells at its place and of its length.

use std::convert::Infallible;
use std::fmt::Write as _;

use host_sim::Error;
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::buffer::{Buffer, Cell};
use ratatui::style::{Color, Modifier};

use super::draw::draw;
use super::shown::Shown;

/// Columns and rows.
pub(crate) type Size = (u16, u16);

pub(crate) fn size(text: &str) -> Result<Size, String> {
    let parts = text.split_once('x');
    let parts = parts.and_then(|(columns, rows)| Some((columns.parse().ok()?, rows.parse().ok()?)));
    let fits = |(columns, rows): &Size| (10..=400).contains(columns) && (3..=200).contains(rows);
    let size = parts.filter(fits);
    size.ok_or_else(|| "allowed: 10x3 to 400x200, as in 100x30".to_owned())
}

pub(crate) fn drawn(shown: &Shown, (columns, rows): Size) -> Result<Buffer, Error> {
    let failed = |error: Infallible| Error::Work(error.to_string());
    let mut terminal = Terminal::new(TestBackend::new(columns, rows)).map_err(failed)?;
    terminal.draw(|frame| draw(frame, shown)).map_err(failed)?;
    Ok(terminal.backend().buffer().clone())
}

/// Size of a cell, and of the letters, pixels.
const WIDTH: f32 = 8.0;
const HEIGHT: f32 = 16.0;
const LETTERS: f32 = 13.0;

const INK: &str = "#202020";
const PAPER: &str = "#fcfcfc";

/// Where the dots of a Braille character's eight bits are.
const DOTS: [(f32, f32); 8] = [
    (0.0, 0.0),
    (0.0, 1.0),
    (0.0, 2.0),
    (1.0, 0.0),
    (1.0, 1.0),
    (1.0, 2.0),
    (0.0, 3.0),
    (1.0, 3.0),
];

pub(crate) fn text(buffer: &Buffer) -> String {
    let mut text = String::new();
    for row in buffer.content.chunks(usize::from(buffer.area.width).max(1)) {
        let line: String = row.iter().map(Cell::symbol).collect();
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

pub(crate) fn svg(buffer: &Buffer) -> String {
    let (width, height) = (
        f32::from(buffer.area.width) * WIDTH,
        f32::from(buffer.area.height) * HEIGHT,
    );
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"monospace\" font-size=\"{LETTERS}\">\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"{PAPER}\"/>\n"
    );
    let rows = buffer.content.chunks(usize::from(buffer.area.width).max(1));
    for (y, row) in rows.enumerate() {
        let mut x = 0;
        for run in row.chunk_by(is_alike) {
            cells(&mut svg, run, x as f32 * WIDTH, y as f32 * HEIGHT);
            x += run.len();
        }
    }
    svg.push_str("</svg>\n");
    svg
}

fn is_alike(a: &Cell, b: &Cell) -> bool {
    (a.fg, a.modifier, is_drawn(a)) == (b.fg, b.modifier, is_drawn(b))
}

/// Whether a cell is not written by a font.
fn is_drawn(cell: &Cell) -> bool {
    let first = cell.symbol().chars().next().unwrap_or(' ');
    matches!(first, '\u{2500}'..='\u{259F}' | '\u{2800}'..='\u{28FF}')
}

fn cells(svg: &mut String, cells: &[Cell], left: f32, top: f32) {
    let Some(first) = cells.first() else {
        return;
    };
    let is_reversed = first.modifier.contains(Modifier::REVERSED);
    let mut ink = colour(first.fg);
    let width = cells.len() as f32 * WIDTH;
    // Writing to a string does not fail.
    if is_reversed {
        let _ = writeln!(
            svg,
            "<rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{HEIGHT}\" fill=\"{ink}\"/>"
        );
        ink = PAPER;
    }
    if is_drawn(first) {
        let shapes = cells.iter().zip(0..);
        let shapes = shapes.map(|(cell, n)| shape(cell, left + n as f32 * WIDTH, top));
        let path: String = shapes.collect();
        let _ = writeln!(svg, "<path d=\"{path}\" fill=\"{ink}\"/>");
        return;
    }
    let text: String = cells.iter().map(Cell::symbol).collect();
    let trimmed = text.trim_end();
    if trimmed.is_empty() {
        return;
    }
    let length = trimmed.chars().count() as f32 * WIDTH;
    let marked = |modifier, mark| first.modifier.contains(modifier).then_some(mark);
    let weight = marked(Modifier::BOLD, " font-weight=\"bold\"").unwrap_or_default();
    let dim = marked(Modifier::DIM, " opacity=\"0.6\"").unwrap_or_default();
    let escaped = trimmed
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;");
    let base = top + 12.0;
    let _ = writeln!(
        svg,
        "<text x=\"{left}\" y=\"{base}\" textLength=\"{length}\" xml:space=\"preserve\" \
         fill=\"{ink}\"{weight}{dim}>{escaped}</text>"
    );
}

fn shape(cell: &Cell, left: f32, top: f32) -> String {
    let first = cell.symbol().chars().next().unwrap_or(' ');
    let block = |x: f32, y: f32, width: f32, height: f32| {
        format!("M{} {}h{width}v{height}h-{width}z", left + x, top + y)
    };
    let (middle, half, line) = (WIDTH / 2.0 - 0.5, HEIGHT / 2.0 - 0.5, 1.0);
    let to = |ends: [bool; 4]| {
        let [up, right, down, left] = ends;
        let mut path = String::new();
        if up {
            path += &block(middle, 0.0, line, half + line);
        }
        if down {
            path += &block(middle, half, line, HEIGHT - half);
        }
        if left {
            path += &block(0.0, half, middle + line, line);
        }
        if right {
            path += &block(middle, half, WIDTH - middle, line);
        }
        path
    };
    match first {
        '─' => to([false, true, false, true]),
        '│' => to([true, false, true, false]),
        '┌' => to([false, true, true, false]),
        '┐' => to([false, false, true, true]),
        '└' => to([true, true, false, false]),
        '┘' => to([true, false, false, true]),
        '█' => block(0.0, 2.0, WIDTH, HEIGHT - 4.0),
        // Seven eighths to one eighth.
        '\u{2589}'..='\u{258F}' => {
            let eighths = (0x2590 - first as u32) as f32;
            block(0.0, 2.0, WIDTH * eighths / 8.0, HEIGHT - 4.0)
        }
        '\u{2800}'..='\u{28FF}' => {
            let bits = first as u32 - 0x2800;
            let dots = DOTS.iter().zip(0..).filter(|(_, bit)| bits >> bit & 1 > 0);
            dots.map(|((x, y), _)| block(1.0 + 4.0 * x, 1.0 + 4.0 * y, 2.0, 2.0))
                .collect()
        }
        _ => String::new(),
    }
}

fn colour(of: Color) -> &'static str {
    match of {
        Color::Cyan => "#00708a",
        Color::Yellow => "#a06000",
        Color::Magenta => "#8a3090",
        Color::Green => "#1c7030",
        Color::Red => "#b02020",
        _ => INK,
    }
}
