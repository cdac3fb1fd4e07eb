//! Curves over time.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::{Fault, SIZE};
use crate::trace::Row;

/// Points of a curve: the lowest and highest value of each stretch of time, so
/// that a vibration keeps its width however long the run.
pub(super) fn envelope(rows: &[Row], value: impl Fn(&Row) -> f64) -> Vec<(f64, f64)> {
    let stretch = rows.len().div_ceil(SIZE.0 as usize).max(1);
    rows.chunks(stretch)
        .flat_map(|rows| {
            let t_s = rows.first().map_or(0.0, |row| row.t_s);
            let values = || rows.iter().map(&value);
            let low = values().fold(f64::INFINITY, f64::min);
            let high = values().fold(f64::NEG_INFINITY, f64::max);
            [(t_s, low), (t_s, high)]
        })
        .collect()
}

#[derive(Debug, Clone, Copy)]
pub(super) enum Stroke {
    Whole(RGBColor),
    Dashed(RGBColor),
}

/// Name, stroke and points of a curve; one that is not a number leaves a gap.
pub(super) type Curve = (&'static str, Stroke, Vec<(f64, f64)>);

/// A dash and the gap behind it, pixels.
const DASH: (u32, u32) = (7, 4);

/// What stands along the axes: quantity and unit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axes<'t> {
    /// Below; none: where another panel below has it.
    pub(super) x: Option<&'t str>,
    pub(super) y: &'t str,
    /// Room on the left, and beyond the end of the axis below, pixels.
    pub(super) room: (u32, u32),
}

/// Width of a legend that stands beside a panel, pixels.
const LEGEND: u32 = 170;

/// Size of a mark, and of a ring around it, pixels.
pub(super) const DOT: i32 = 4;
pub(super) const RING: i32 = 7;

/// A number on an axis, as people write it: 140, 0.5.
pub(super) fn plain(value: f64) -> String {
    // Sums of steps are not exact.
    let rounded = (value * 1e6).round() / 1e6;
    // Neither -0.
    (rounded + 0.0).to_string()
}

/// What stands in a legend before a name.
#[derive(Debug, Clone, Copy)]
pub(super) enum Sign {
    Line(Stroke),
    Square(RGBColor),
    Dot(RGBColor),
    Cross(RGBColor),
    Triangle(RGBColor),
    /// A ring, which stands around another.
    Ring(RGBColor),
}

pub(super) fn entries(curves: &[Curve]) -> Vec<(Sign, &'static str)> {
    let line = |(name, stroke, _): &Curve| (Sign::Line(*stroke), *name);
    curves.iter().map(line).collect()
}

/// A panel in two: for what it shows, and for its legend, which is drawn.
pub(super) fn with_legend<DB: DrawingBackend<ErrorType: 'static>>(
    area: &DrawingArea<DB, Shift>,
    entries: &[(Sign, &str)],
) -> Result<DrawingArea<DB, Shift>, Fault> {
    let width = area.dim_in_pixel().0.saturating_sub(LEGEND) as i32;
    let (panel, legend) = area.split_horizontally(width);
    for (y, (sign, name)) in (16..).step_by(18).zip(entries) {
        match *sign {
            Sign::Line(stroke) => {
                let (dashes, colour) = match stroke {
                    Stroke::Whole(colour) => (vec![(4, 22)], colour),
                    Stroke::Dashed(colour) => (vec![(4, 11), (15, 22)], colour),
                };
                for (from, to) in dashes {
                    let line = vec![(from, y), (to, y)];
                    legend.draw(&PathElement::new(line, colour.stroke_width(2)))?;
                }
            }
            Sign::Square(colour) => {
                let corners = [(6, y - 6), (20, y + 6)];
                legend.draw(&Rectangle::new(corners, colour.filled()))?;
            }
            Sign::Dot(colour) => legend.draw(&Circle::new((13, y), DOT, colour.filled()))?,
            Sign::Cross(colour) => {
                legend.draw(&Cross::new((13, y), DOT, colour.stroke_width(2)))?;
            }
            Sign::Triangle(colour) => {
                legend.draw(&TriangleMarker::new((13, y), DOT + 1, colour.filled()))?;
            }
            Sign::Ring(colour) => {
                legend.draw(&Circle::new((13, y), RING, colour.stroke_width(1)))?;
            }
        }
        let style = ("sans-serif", 13).into_font().color(&BLACK);
        let middle = Pos::new(HPos::Left, VPos::Center);
        let style = style.pos(middle);
        legend.draw(&Text::new((*name).to_owned(), (28, y), style))?;
    }
    Ok(panel)
}

/// From below the lowest point of the curves to above the highest, at least `least` apart,
/// with some room.
pub(super) fn range(curves: &[Curve], least: f64) -> (f64, f64) {
    let points = || curves.iter().flat_map(|(_, _, points)| points);
    let values = || points().map(|(_, y)| *y).filter(|y| y.is_finite());
    let low = values().fold(f64::INFINITY, f64::min);
    let high = values().fold(f64::NEG_INFINITY, f64::max);
    if low > high {
        return (0.0, least);
    }
    let span = (high - low).max(least);
    let middle = f64::midpoint(low, high);
    (middle - 0.56 * span, middle + 0.56 * span)
}

pub(super) fn curves<DB: DrawingBackend<ErrorType: 'static>>(
    area: &DrawingArea<DB, Shift>,
    axes: Axes<'_>,
    (from, to): (f64, f64),
    (low, high): (f64, f64),
    curves: Vec<Curve>,
) -> Result<(), Fault> {
    let mut chart = ChartBuilder::on(area)
        .margin(6)
        .x_label_area_size(if axes.x.is_some() { 40 } else { 24 })
        .margin_right(axes.room.1)
        .y_label_area_size(axes.room.0)
        .build_cartesian_2d(from..to, low..high)?;
    let mut mesh = chart.configure_mesh();
    mesh.light_line_style(WHITE).y_desc(axes.y);
    let plain = |value: &f64| plain(*value);
    mesh.x_label_formatter(&plain).y_label_formatter(&plain);
    if let Some(x) = axes.x {
        mesh.x_desc(x);
    }
    mesh.draw()?;
    for (_, stroke, points) in curves {
        for piece in points.split(|(_, y)| y.is_nan()) {
            let piece = piece.to_vec();
            match stroke {
                Stroke::Whole(colour) => {
                    chart.draw_series(LineSeries::new(piece, colour.stroke_width(1)))?;
                }
                Stroke::Dashed(colour) => {
                    let style = colour.stroke_width(1);
                    chart.draw_series(DashedLineSeries::new(piece, DASH.0, DASH.1, style))?;
                }
            }
        }
    }
    Ok(())
}
