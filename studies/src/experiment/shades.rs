//! Pictures of shaded cells: confusion matrices, and spectra over time.

use anyhow::Result;
use plotters::prelude::*;
use tactile::score::Confusion;

use crate::chart::{Area, COLOURS, Fault, grid};
use crate::page::percent_of;

pub(super) struct Matrix {
    pub(super) title: String,
    pub(super) classes: Vec<String>,
    pub(super) score: Confusion,
}

pub(super) struct Spectrogram {
    pub(super) title: String,
    pub(super) time_s: f64,
    /// The frequency at which the last row ends, Hz.
    pub(super) highest_hz: f64,
    /// `[time][frequency]`.
    pub(super) power: Vec<Vec<f64>>,
}

/// What of a spectrogram is drawn white, below the most, dB.
pub(super) const RANGE_DB: f64 = 60.0;

type Corners = [(i32, i32); 2];

fn write(area: &Area<'_>, text: &str, at: (i32, i32), size: i32) -> Result<(), Fault> {
    Ok(area.draw(&Text::new(text.to_owned(), at, ("sans-serif", size)))?)
}

fn fill(area: &Area<'_>, corners: Corners, colour: RGBColor) -> Result<(), Fault> {
    Ok(area.draw(&Rectangle::new(corners, colour.filled()))?)
}

fn frame(area: &Area<'_>, corners: Corners) -> Result<(), Fault> {
    Ok(area.draw(&Rectangle::new(corners, COLOURS[0]))?)
}

/// A square of cells each, from white to dark blue by the share of their row.
pub(super) fn matrices(all: &[Matrix], columns: usize) -> Result<String> {
    /// Pixels of the square, and where it begins.
    const SQUARE: i32 = 240;
    const CORNER: (i32, i32) = (78, 36);
    let shade = |share: f64| {
        let share = share.clamp(0.0, 1.0);
        let part = |dark: f64| (255.0 - share * (255.0 - dark)).round() as u8;
        RGBColor(part(10.0), part(50.0), part(110.0))
    };
    grid(all, columns, (330, 330), |matrix, area| {
        write(area, &matrix.title, (10, 8), 16)?;
        let (left, top) = CORNER;
        let count = matrix.classes.len();
        let step = SQUARE / (count.max(1) as i32);
        let end = step * count as i32;
        for (n, name) in matrix.classes.iter().enumerate() {
            let y = top + step * n as i32;
            write(area, name, (8, y + step / 2 - 7), 13)?;
            // Names below need room: every second one where there are many.
            if count < 6 || n.is_multiple_of(2) {
                write(area, name, (left + step * n as i32 + 2, top + end + 6), 13)?;
            }
            for k in 0..count {
                let x = left + step * k as i32;
                let share = percent_of(&matrix.score, n, k) / 100.0;
                fill(area, [(x, y), (x + step, y + step)], shade(share))?;
            }
        }
        frame(area, [(left, top), (left + end, top + end)])
    })
}

/// A rectangle of cells each, shaded alike: black the most of all.
pub(super) fn spectrograms(all: &[Spectrogram], columns: usize) -> Result<String> {
    /// Where the rectangle begins, and its pixels.
    const CORNER: (i32, i32) = (46, 30);
    const SIZE: (f64, f64) = (270.0, 200.0);
    let powers = all.iter().flat_map(|one| one.power.iter().flatten());
    let most = powers.copied().fold(f64::MIN_POSITIVE, f64::max);
    let shade = |power: f64| {
        let db = 10.0 * libm::log10((power / most).max(f64::MIN_POSITIVE));
        (-db / RANGE_DB * 255.0).clamp(0.0, 255.0).round() as u8
    };
    grid(all, columns, (330, 270), |one, area| {
        write(area, &one.title, (10, 8), 13)?;
        let (left, top) = CORNER;
        let (right, bottom) = (left + SIZE.0 as i32, top + SIZE.1 as i32);
        let times = one.power.len().max(1) as f64;
        for (time, spectrum) in one.power.iter().enumerate() {
            let x = |n: usize| left + (SIZE.0 * n as f64 / times).round() as i32;
            let count = spectrum.len().max(1) as f64;
            for (bin, power) in spectrum.iter().enumerate() {
                let grey = shade(*power);
                if grey == u8::MAX {
                    continue;
                }
                let y = |n: usize| bottom - (SIZE.1 * n as f64 / count).round() as i32;
                let ends = [(x(time), y(bin + 1)), (x(time + 1), y(bin))];
                fill(area, ends, RGBColor(grey, grey, grey))?;
            }
        }
        frame(area, [(left, top), (right, bottom)])?;
        write(area, &format!("{:.0} Hz", one.highest_hz), (2, top), 13)?;
        write(area, "0", (left - 14, bottom - 14), 13)?;
        let time = format!("{:.1} s", one.time_s);
        write(area, &time, (right - 30, bottom + 6), 13)
    })
}
