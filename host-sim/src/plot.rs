//! Pictures: of a run, position, contact and what was decided; of both sides of some runs;
//! and of a calibration.

mod sides;

pub use sides::{Panel, sides};

use plotters::prelude::*;
use tactile::score::Interval;

use crate::Error;
use crate::bench::Bench;
use crate::decisions::{Decided, UNKNOWN, Verdict};
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
            rows: &self.rows,
            classes,
            presented: &self.presented,
            decided,
        }
    }
}

/// A class that was presented for a while, s.
#[derive(Debug, Clone, PartialEq)]
pub struct Presented {
    /// When it began and ended.
    pub span_s: (f64, f64),
    /// Its name.
    pub label: String,
}

/// What the picture shows.
#[derive(Debug)]
pub struct Picture<'a> {
    /// Its title.
    pub title: &'a str,
    /// The ticks it shows.
    pub rows: &'a [Row],
    /// Names of the classes, from below.
    pub classes: &'a [String],
    /// The classes that were presented.
    pub presented: &'a [Presented],
    /// The decisions.
    pub decided: &'a [Decided],
}

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;
type Fault = Box<dyn std::error::Error>;

const SIZE: (u32, u32) = (1000, 760);
const SETPOINT: RGBColor = RGBColor(150, 150, 150);
const MEASURED: RGBColor = RGBColor(0, 90, 170);
const CONTACT: RGBColor = RGBColor(200, 90, 0);
const RIGHT: RGBColor = RGBColor(0, 130, 60);
const WRONG: RGBColor = RGBColor(190, 20, 20);
const TRUTH: RGBColor = RGBColor(220, 225, 230);

/// The left whisker as an SVG document: setpoint and measured angle, what the
/// sensor felt, contact and suppression, and each decision against the true class.
///
/// # Errors
/// [`Error::Work`] if the drawing library fails.
pub fn left_whisker(picture: &Picture<'_>) -> Result<String, Error> {
    drawn(picture).map_err(|fault| Error::Work(format!("plot: {fault}")))
}

fn drawn(picture: &Picture<'_>) -> Result<String, Fault> {
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        let root = root.titled(picture.title, ("sans-serif", 20))?;
        let classifies = !picture.classes.is_empty();
        let areas = root.split_evenly((3 + usize::from(classifies), 1));
        let [angle, sensor, contact, classes @ ..] = areas.as_slice() else {
            return Err("the drawing area does not split".into());
        };
        let rows = picture.rows;
        let span = (
            rows.first().map_or(0.0, |row| row.t_s),
            rows.last().map_or(1.0, |row| row.t_s),
        );
        let left = |value| envelope(rows, value);
        let setpoint = ("setpoint", SETPOINT, left(|row| row.theta_deg[0]));
        let measured = ("measured", MEASURED, left(|row| row.angle_deg[0]));
        curves(
            angle,
            "degrees",
            span,
            (40.0, 160.0),
            vec![setpoint, measured],
        )?;
        let x = ("x", MEASURED, left(|row| row.x[0]));
        curves(sensor, "codes", span, (4000.0, 18_000.0), vec![x])?;
        let pi = ("contact", CONTACT, left(|row| row.contact[0]));
        let z = ("suppression z", SETPOINT, left(|row| row.z[0]));
        curves(contact, "", span, (0.0, 1.2), vec![pi, z])?;
        if let [classes] = classes {
            decisions(classes, picture, span)?;
        }
        root.present()?;
    }
    Ok(svg)
}

/// Points of a curve: the lowest and highest value of each stretch of time, so
/// that a vibration keeps its width however long the run.
fn envelope(rows: &[Row], value: fn(&Row) -> f64) -> Vec<(f64, f64)> {
    let stretch = rows.len().div_ceil(SIZE.0 as usize).max(1);
    rows.chunks(stretch)
        .flat_map(|rows| {
            let t_s = rows.first().map_or(0.0, |row| row.t_s);
            let values = || rows.iter().map(value);
            let low = values().fold(f64::INFINITY, f64::min);
            let high = values().fold(f64::NEG_INFINITY, f64::max);
            [(t_s, low), (t_s, high)]
        })
        .collect()
}

type Curve = (&'static str, RGBColor, Vec<(f64, f64)>);

fn curves(
    area: &Area<'_>,
    unit: &str,
    (from, to): (f64, f64),
    (low, high): (f64, f64),
    curves: Vec<Curve>,
) -> Result<(), Fault> {
    let mut chart = ChartBuilder::on(area)
        .margin(6)
        .x_label_area_size(24)
        .y_label_area_size(64)
        .build_cartesian_2d(from..to, low..high)?;
    chart
        .configure_mesh()
        .light_line_style(WHITE)
        .y_desc(unit)
        .draw()?;
    for (name, colour, points) in curves {
        chart
            .draw_series(LineSeries::new(points, colour.stroke_width(1)))?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], colour));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .background_style(WHITE.mix(0.8))
        .draw()?;
    Ok(())
}

/// A row for each class, and one of what was unknown: grey where it was presented, a dot
/// for each decision, a ring for one of the right side.
fn decisions(area: &Area<'_>, picture: &Picture<'_>, (from, to): (f64, f64)) -> Result<(), Fault> {
    let classes = picture.classes.iter().map(String::as_str);
    let rows: Vec<&str> = classes.chain([UNKNOWN]).collect();
    let count = rows.len();
    let mut chart = ChartBuilder::on(area)
        .margin(6)
        .x_label_area_size(36)
        .y_label_area_size(64)
        .build_cartesian_2d(from..to, -0.5..count as f64 - 0.5)?;
    let name = |height: &f64| {
        let class = height.round();
        let on_row = (height - class).abs() < 1e-6 && class >= 0.0;
        let name = rows.get(class as usize).filter(|_| on_row);
        name.copied().unwrap_or_default().to_owned()
    };
    let mut legend =
        "s; grey: presented; a dot: a decision, green right, red wrong, blue refused".to_owned();
    if picture.decided.iter().any(is_right) {
        legend.push_str("; a ring: by the right side");
    }
    chart
        .configure_mesh()
        .disable_mesh()
        .y_labels(count)
        .y_label_formatter(&name)
        .x_desc(legend)
        .draw()?;
    // What the model does not know stands where the right decision does.
    let row = |label: &str| rows.iter().position(|row| *row == label);
    for Presented {
        span_s: (start, end),
        label,
    } in picture.presented
    {
        let height = row(label).unwrap_or(picture.classes.len()) as f64;
        let corners = [(*start, height - 0.4), (end.min(to), height + 0.4)];
        chart.draw_series([Rectangle::new(corners, TRUTH.filled())])?;
        if row(label).is_none() {
            let style = ("sans-serif", 13).into_font().color(&SETPOINT);
            let place = (*start, height + 0.35);
            chart.draw_series([Text::new(format!(" {label}"), place, style)])?;
        }
    }
    for decided in picture.decided {
        let (Some(t_s), Some(row)) = (decided.t_s, row(&decided.decision)) else {
            continue;
        };
        if !(from..=to).contains(&t_s) {
            continue;
        }
        let colour = match decided.verdict(picture.classes) {
            Verdict::Right => RIGHT,
            Verdict::Wrong => WRONG,
            Verdict::Refused => MEASURED,
        };
        let style = if is_right(decided) {
            colour.stroke_width(2)
        } else {
            colour.filled()
        };
        chart.draw_series([Circle::new((t_s, row as f64), 4, style)])?;
    }
    Ok(())
}

/// Whether a whisker of the right side decided.
fn is_right(decided: &Decided) -> bool {
    decided.place.is_some_and(|place| place.side != 0)
}

/// The least error that the picture of a calibration shows, as a power of ten: what states
/// or finds less stands at its edge.
const LEAST: f64 = 4.0;

/// Stated against found as an SVG document: of each point the posterior that was stated,
/// and the share that was right with its interval. On both axes the distance to one is
/// logarithmic. On the diagonal a posterior is what it says; below it, it says too much.
///
/// # Errors
/// [`Error::Work`] if the drawing library fails.
pub fn calibration(title: &str, points: &[(f64, Interval)]) -> Result<String, Error> {
    calibrated(title, points).map_err(|fault| Error::Work(format!("plot: {fault}")))
}

fn calibrated(title: &str, points: &[(f64, Interval)]) -> Result<String, Fault> {
    let place = |share: f64| -(1.0 - share).max(f64::MIN_POSITIVE).log10().max(-LEAST);
    let percent = |place: &f64| format!("{} %", 100.0 - 10_f64.powf(2.0 - place));
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (560, 560)).into_drawing_area();
        root.fill(&WHITE)?;
        let mut chart = ChartBuilder::on(&root)
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
        ] {
            let style = ("sans-serif", 15).into_font().color(&SETPOINT);
            chart.draw_series([Text::new(text, at, style)])?;
        }
        for (stated, found) in points.iter().filter(|(_, found)| found.count > 0) {
            let x = place(*stated);
            let interval = [found.low, found.high].map(|share| (x, place(share)));
            chart.draw_series(LineSeries::new(interval, MEASURED.stroke_width(1)))?;
            let point = (x, place(found.share));
            chart.draw_series([Circle::new(point, 4, MEASURED.filled())])?;
        }
        root.present()?;
    }
    Ok(svg)
}
