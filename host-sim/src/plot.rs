//! A picture of a run: position, contact and what was decided.

use plotters::prelude::*;

use crate::decisions::{Decided, UNKNOWN};
use crate::trace::Row;

/// A decision and its time, s.
#[derive(Debug, Clone)]
pub struct Mark {
    /// When.
    pub t_s: f64,
    /// What.
    pub decided: Decided,
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
    pub marks: &'a [Mark],
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
/// If the drawing library fails.
pub fn left_whisker(picture: &Picture<'_>) -> Result<String, Fault> {
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        let root = root.titled(picture.title, ("sans-serif", 20))?;
        let areas = root.split_evenly((4, 1));
        let [angle, sensor, contact, classes] = areas.as_slice() else {
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
            (40.0, 140.0),
            vec![setpoint, measured],
        )?;
        let x = ("x", MEASURED, left(|row| row.x[0]));
        curves(sensor, "codes", span, (6000.0, 15_000.0), vec![x])?;
        let pi = ("contact", CONTACT, left(|row| row.contact[0]));
        let z = ("suppression z", SETPOINT, left(|row| row.z[0]));
        curves(contact, "", span, (0.0, 1.2), vec![pi, z])?;
        decisions(classes, picture, span)?;
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
/// for each decision.
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
    chart
        .configure_mesh()
        .disable_mesh()
        .y_labels(count)
        .y_label_formatter(&name)
        .x_desc("s; grey: presented, green: right decision, red: wrong one, blue: none of these")
        .draw()?;
    let row = |label: &str| rows.iter().position(|row| *row == label);
    for Presented {
        span_s: (start, end),
        label,
    } in picture.presented
    {
        let Some(row) = row(label).filter(|_| *start < to) else {
            continue;
        };
        let corners = [(*start, row as f64 - 0.4), (end.min(to), row as f64 + 0.4)];
        chart.draw_series([Rectangle::new(corners, TRUTH.filled())])?;
    }
    for mark in picture
        .marks
        .iter()
        .filter(|mark| (from..=to).contains(&mark.t_s))
    {
        let Some(row) = row(&mark.decided.decision) else {
            continue;
        };
        let colour = match mark.decided.decision.as_str() {
            UNKNOWN => MEASURED,
            _ if mark.decided.is_right() => RIGHT,
            _ => WRONG,
        };
        chart.draw_series([Circle::new((mark.t_s, row as f64), 4, colour.filled())])?;
    }
    Ok(())
}
