//! Spectra over time as pictures: a rectangle of shaded cells each.

use anyhow::Result;
use plotters::prelude::*;

use crate::chart::grid;

/// What is drawn white, below the most, dB.
pub(super) const RANGE_DB: f64 = 60.0;

pub(super) struct Spectrogram {
    pub(super) title: String,
    pub(super) time_s: f64,
    /// The frequency at which the last row ends, Hz.
    pub(super) highest_hz: f64,
    /// `[time][frequency]`.
    pub(super) power: Vec<Vec<f64>>,
}

const PANEL: (u32, u32) = (330, 270);
const CORNER: (i32, i32) = (46, 30);
const SIZE: (f64, f64) = (270.0, 200.0);

/// The shade of a power beside the most: white at −[`RANGE_DB`] or below.
fn shade(power: f64, most: f64) -> u8 {
    let db = 10.0 * libm::log10((power / most).max(f64::MIN_POSITIVE));
    (-db / RANGE_DB * 255.0).clamp(0.0, 255.0).round() as u8
}

/// Spectrograms in so many columns, shaded alike.
pub(super) fn draw(all: &[Spectrogram], columns: usize) -> Result<String> {
    let powers = all.iter().flat_map(|one| one.power.iter().flatten());
    let most = powers.copied().fold(f64::MIN_POSITIVE, f64::max);
    grid(all, columns, PANEL, |one, area| {
        let text =
            |text: String, at: (i32, i32)| area.draw(&Text::new(text, at, ("sans-serif", 13)));
        text(one.title.clone(), (10, 8))?;
        let (left, top) = CORNER;
        let (right, bottom) = (left + SIZE.0 as i32, top + SIZE.1 as i32);
        let times = one.power.len().max(1) as f64;
        for (time, spectrum) in one.power.iter().enumerate() {
            let x = |n: usize| left + (SIZE.0 * n as f64 / times).round() as i32;
            let count = spectrum.len().max(1) as f64;
            for (bin, power) in spectrum.iter().enumerate() {
                let grey = shade(*power, most);
                if grey == u8::MAX {
                    continue;
                }
                let y = |n: usize| bottom - (SIZE.1 * n as f64 / count).round() as i32;
                let ends = [(x(time), y(bin + 1)), (x(time + 1), y(bin))];
                area.draw(&Rectangle::new(ends, RGBColor(grey, grey, grey).filled()))?;
            }
        }
        let frame = [(left, top), (right, bottom)];
        area.draw(&Rectangle::new(frame, RGBColor(110, 110, 110)))?;
        text(format!("{:.0} Hz", one.highest_hz), (2, top))?;
        text("0".to_owned(), (left - 14, bottom - 14))?;
        text(format!("{:.1} s", one.time_s), (right - 30, bottom + 6))?;
        Ok(())
    })
}
