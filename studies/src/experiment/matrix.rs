//! Confusion matrices as pictures: a square of shaded cells each.

use anyhow::Result;
use plotters::prelude::*;
use tactile::score::Confusion;

use crate::chart::grid;
use crate::page::percent_of;

pub(super) struct Matrix {
    pub(super) title: String,
    pub(super) classes: Vec<String>,
    pub(super) score: Confusion,
}

/// Pixels of a panel, of its square of cells, and where that begins.
const PANEL: (u32, u32) = (330, 330);
const SQUARE: i32 = 240;
const CORNER: (i32, i32) = (78, 36);

/// The colour of a share of a row, 0 to 1: from white to dark blue.
fn shade(share: f64) -> RGBColor {
    let share = share.clamp(0.0, 1.0);
    let part = |dark: f64| (255.0 - share * (255.0 - dark)).round() as u8;
    RGBColor(part(10.0), part(50.0), part(110.0))
}

pub(super) fn draw(matrices: &[Matrix], columns: usize) -> Result<String> {
    grid(matrices, columns, PANEL, |matrix, area| {
        let text = |text: &str, at: (i32, i32), size: i32| {
            area.draw(&Text::new(text.to_owned(), at, ("sans-serif", size)))
        };
        text(&matrix.title, (10, 8), 16)?;
        let (left, top) = CORNER;
        let step = SQUARE / (matrix.classes.len().max(1) as i32);
        let end = step * matrix.classes.len() as i32;
        for (n, name) in matrix.classes.iter().enumerate() {
            let y = top + step * n as i32;
            text(name, (8, y + step / 2 - 7), 13)?;
            // Names below need room: every second one where there are many.
            if matrix.classes.len() < 6 || n.is_multiple_of(2) {
                text(name, (left + step * n as i32 + 2, top + end + 6), 13)?;
            }
            for k in 0..matrix.classes.len() {
                let x = left + step * k as i32;
                let share = percent_of(&matrix.score, n, k) / 100.0;
                let cell = Rectangle::new([(x, y), (x + step, y + step)], shade(share).filled());
                area.draw(&cell)?;
            }
        }
        let frame = [(left, top), (left + end, top + end)];
        Ok(area.draw(&Rectangle::new(frame, RGBColor(110, 110, 110)))?)
    })
}
