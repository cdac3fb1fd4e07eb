//! Pictures: of a run, position, contact and what was decided; of both sides of some runs;
//! of what was measured at a bench; and of how far a classifier's certainty can be relied on.

mod curves;
mod decided;
mod pixels;
mod sides;
mod strips;
mod whiskers;

pub use sides::{Panel, sides};
pub use strips::{Ink, Points, Strip, Strips};

use std::fmt::Display;

use pixels::Pixels;
use plotters::coord::Shift;
use plotters::prelude::*;
use tactile::score::Interval;

use crate::Error;
use crate::bench::Bench;
use crate::decisions::Decided;
use crate::run::Run;
use crate::trace::Row;

/// How much of a run a picture shows, s.
const PLOTTED_S: f64 = 10.0;

/// What a picture needs of a run, tick by tick.
#[derive(Debug, Default)]
pub struct Film {
    rows: Vec<Row>,
    presented: Vec<Presented>,
}

impl Film {
    /// Takes what is to be seen of the run's last tick.
    pub fn take<B: Bench + ?Sized>(&mut self, run: &Run<B>) {
        let (row, (label, _)) = (run.row(), run.presented());
        if row.t_s > PLOTTED_S {
            return;
        }
        self.rows.push(*row);
        match self.presented.last_mut().filter(|last| last.label == label) {
            Some(last) => last.span_s.1 = row.t_s,
            None => self.presented.push(Presented {
                span_s: (row.t_s, row.t_s),
                label: label.to_owned(),
            }),
        }
    }

    /// The picture.
    pub fn picture<'a>(
        &'a self,
        title: &'a str,
        classes: &'a [String],
        decided: &'a [Decided],
    ) -> Picture<'a> {
        Picture {
            title,
            film: self,
            classes,
            decided,
        }
    }
}

/// The title of a run's picture: what it shows, and how much of the run.
pub fn title(what: &str, duration_s: f64) -> String {
    if duration_s > PLOTTED_S {
        format!("{what} (the first {PLOTTED_S} s of {duration_s} s)")
    } else {
        what.to_owned()
    }
}

/// A class that was presented, and when that began and ended, s.
#[derive(Debug)]
struct Presented {
    span_s: (f64, f64),
    label: String,
}

/// What the picture shows.
#[derive(Debug)]
pub struct Picture<'a> {
    title: &'a str,
    film: &'a Film,
    /// Names of the classes, from below.
    classes: &'a [String],
    decided: &'a [Decided],
}

type Fault = Box<dyn std::error::Error>;

fn failed(fault: impl Display) -> Error {
    Error::Work(format!("plot: {fault}"))
}

/// What is drawn on an area of this size, as an SVG document.
fn svg_of(
    size: (u32, u32),
    draw: impl FnOnce(&DrawingArea<SVGBackend<'_>, Shift>) -> Result<(), Fault>,
) -> Result<String, Error> {
    let mut svg = String::new();
    let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
    draw(&root).map_err(failed)?;
    drop(root);
    Ok(svg)
}

fn png_of(
    size: (u32, u32),
    draw: impl FnOnce(&DrawingArea<&mut Pixels, Shift>) -> Result<(), Fault>,
) -> Result<Vec<u8>, Error> {
    let mut pixels = Pixels::new(size)?;
    let root = (&mut pixels).into_drawing_area();
    draw(&root).map_err(failed)?;
    drop(root);
    pixels.png()
}

const SIZE: (u32, u32) = (1000, 760);
const SETPOINT: RGBColor = RGBColor(150, 150, 150);
const MEASURED: RGBColor = RGBColor(0, 90, 170);
/// The right side, or another curve beside a measured one.
const OTHER: RGBColor = RGBColor(200, 90, 0);
const RIGHT: RGBColor = RGBColor(0, 130, 60);
const WRONG: RGBColor = RGBColor(190, 20, 20);
const REFUSED: RGBColor = RGBColor(110, 70, 150);
const TRUTH: RGBColor = RGBColor(220, 225, 230);

/// The least error that the picture of a calibration shows, as a power of ten: what states
/// or finds less stands at its edge, as a ring.
const LEAST: f64 = 4.0;

/// Stated against found as an SVG document: of each point the posterior that was stated,
/// and the share that was right with its interval. On both axes the distance to one is
/// logarithmic. On the diagonal a posterior is what it says; below it, it says too much.
///
/// # Errors
/// [`Error::Work`] if the drawing library fails.
pub fn calibration(title: &str, points: &[(f64, Interval)]) -> Result<String, Error> {
    let place = |share: f64| -(1.0 - share).max(f64::MIN_POSITIVE).log10().max(-LEAST);
    let percent = |place: &f64| format!("{} %", 100.0 - 10_f64.powf(2.0 - place));
    svg_of((560, 560), |root| {
        root.fill(&WHITE)?;
        let mut chart = ChartBuilder::on(root)
            .caption(title, ("sans-serif", 20))
            .margin(12)
            .x_label_area_size(44)
            .y_label_area_size(64)
            .build_cartesian_2d(0.0..LEAST, 0.0..LEAST)?;
        chart
            .configure_mesh()
            .light_line_style(WHITE)
            .x_labels(5)
            .y_labels(5)
            .x_label_formatter(&percent)
            .y_label_formatter(&percent)
            .x_desc("stated: mean posterior")
            .y_desc("found: share of right decisions, 95 % interval")
            .draw()?;
        let diagonal = [(0.0, 0.0), (LEAST, LEAST)];
        chart.draw_series(LineSeries::new(diagonal, SETPOINT.stroke_width(1)))?;
        for (text, at) in [
            ("says too little", (0.2, 3.7)),
            ("says too much", (2.9, 0.3)),
            ("ring: off the scale", (0.2, 3.5)),
        ] {
            let style = ("sans-serif", 15).into_font().color(&SETPOINT);
            chart.draw_series([Text::new(text, at, style)])?;
        }
        for (stated, found) in points.iter().filter(|(_, found)| found.count > 0) {
            let x = place(*stated);
            let interval = [found.low, found.high].map(|share| (x, place(share)));
            chart.draw_series(LineSeries::new(interval, MEASURED.stroke_width(1)))?;
            let point = (x, place(found.share));
            let is_off = [*stated, found.share].map(|share| 1.0 - share < 10_f64.powf(-LEAST));
            let style = if is_off.contains(&true) {
                MEASURED.stroke_width(2)
            } else {
                MEASURED.filled()
            };
            chart.draw_series([Circle::new(point, 4, style)])?;
        }
        Ok(root.present()?)
    })
}
