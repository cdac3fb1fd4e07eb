//! Quantities over time, one below the other: a picture of what was measured at a bench.

use plotters::coord::Shift;
use plotters::prelude::*;

use super::curves::{Axes, Curve, Stroke, curves, entries, range, with_legend};
use super::{Fault, MEASURED, SETPOINT, png_of, svg_of};
use crate::Error;

/// Width of the picture, and height of a strip, pixels.
const WIDTH: u32 = 1000;
const HEIGHT: u32 = 230;
/// More points of a curve than this are not seen.
const POINTS: usize = 4_000;

/// How a curve is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ink {
    /// As what should be.
    Wanted,
    /// As what is.
    Found,
}

/// A quantity, or some of the same unit.
#[derive(Debug, Clone)]
pub struct Strip {
    /// Quantity and unit.
    pub y: &'static str,
    /// What the axis spans at least.
    pub least: f64,
    /// Each with its name.
    pub curves: Vec<(&'static str, Ink, Points)>,
}

/// Points of a curve: s, and the unit of its strip; not a number: a gap.
pub type Points = Vec<(f64, f64)>;

/// Strips with one time.
#[derive(Debug, Clone)]
pub struct Strips {
    /// What they show.
    pub title: String,
    /// From above.
    pub strips: Vec<Strip>,
}

impl Strips {
    /// As an SVG document.
    ///
    /// # Errors
    /// [`Error::Work`] if the drawing library fails.
    pub fn svg(&self) -> Result<String, Error> {
        svg_of(self.size(), |root| self.drawn(root))
    }

    /// As a PNG file.
    ///
    /// # Errors
    /// [`Error::Work`] if the drawing library fails.
    pub fn png(&self) -> Result<Vec<u8>, Error> {
        png_of(self.size(), |root| self.drawn(root))
    }

    fn size(&self) -> (u32, u32) {
        (WIDTH, 40 + HEIGHT * self.strips.len() as u32)
    }

    fn drawn<DB: DrawingBackend<ErrorType: 'static>>(
        &self,
        root: &DrawingArea<DB, Shift>,
    ) -> Result<(), Fault> {
        root.fill(&WHITE)?;
        let root = root.titled(&self.title, ("sans-serif", 20))?;
        let areas = root.split_evenly((self.strips.len(), 1));
        let shown = || self.strips.iter().flat_map(|strip| &strip.curves);
        let points = || shown().flat_map(|(_, _, points)| points);
        let times = || points().map(|(t_s, _)| *t_s);
        let from = times().fold(f64::INFINITY, f64::min);
        let to = times().fold(f64::NEG_INFINITY, f64::max);
        let span = if from < to { (from, to) } else { (0.0, 1.0) };
        for (n, (area, strip)) in areas.iter().zip(&self.strips).enumerate() {
            let shown = strip.curves.iter().map(|(name, ink, points)| {
                let stroke = Stroke::Whole(ink.colour());
                (*name, stroke, thinned(points))
            });
            let shown: Vec<Curve> = shown.collect();
            let area = with_legend(area, &entries(&shown))?;
            let is_last = n + 1 == self.strips.len();
            let (x, y, room) = (is_last.then_some("time, s"), strip.y, (64, 16));
            let axes = Axes { x, y, room };
            curves(&area, axes, span, range(&shown, strip.least), shown)?;
        }
        Ok(root.present()?)
    }
}

impl Ink {
    const fn colour(self) -> RGBColor {
        match self {
            Self::Wanted => SETPOINT,
            Self::Found => MEASURED,
        }
    }
}

/// The lowest and the highest point of each stretch, so that no peak is lost; gaps stay.
fn thinned(points: &[(f64, f64)]) -> Points {
    let stretch = 2 * points.len().div_ceil(POINTS).max(1);
    if stretch == 2 {
        return points.to_vec();
    }
    let ends = |points: &[(f64, f64)]| {
        let by_height = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
        let low = points.iter().min_by(by_height).into_iter();
        let mut ends: Points = low
            .chain(points.iter().max_by(by_height))
            .copied()
            .collect();
        ends.sort_by(|a, b| a.0.total_cmp(&b.0));
        ends
    };
    let gap = (f64::NAN, f64::NAN);
    let pieces = points.split(|(_, y)| y.is_nan());
    let thin = pieces.map(|piece| piece.chunks(stretch).flat_map(ends).collect::<Points>());
    thin.collect::<Vec<_>>().join(&gap)
}
