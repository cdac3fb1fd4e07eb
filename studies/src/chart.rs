//! Panels of curves with linear or logarithmic axes, as SVG documents.

use anyhow::{Result, anyhow};
use std::ops::Range;

use plotters::coord::Shift;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use plotters::prelude::*;

use crate::moments::range;

pub(crate) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub(crate) type Fault = Box<dyn std::error::Error>;

#[derive(Debug, Clone)]
pub(crate) struct Axis {
    pub(crate) name: &'static str,
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) log: bool,
}

impl Axis {
    /// A logarithmic axis of whole decades around the positive of `values`.
    pub(crate) fn decades(name: &'static str, values: impl Iterator<Item = f64>) -> Self {
        let ends = range(values.filter(|value| *value > 0.0 && value.is_finite()));
        let (low, high) = if ends.0 <= ends.1 { ends } else { (1.0, 1.0) };
        let power = |exponent: f64| libm::pow(10.0, exponent);
        let from = libm::log10(low).floor();
        let to = libm::log10(high).ceil().max(from + 1.0);
        Self {
            name,
            low: power(from),
            high: power(to),
            log: true,
        }
    }

    /// 1, 2 or 5 times a power of ten: four to ten of them on a linear axis.
    fn step(&self) -> f64 {
        let rough = ((self.high - self.low) / 10.0).max(f64::MIN_POSITIVE);
        let power = libm::pow(10.0, libm::log10(rough).floor());
        let factor = [1.0, 2.0, 5.0].into_iter().find(|f| f * power >= rough);
        factor.unwrap_or(10.0) * power
    }

    fn place(&self, value: f64) -> f64 {
        let scale = |x: f64| if self.log { libm::log10(x) } else { x };
        (scale(value) - scale(self.low)) / (scale(self.high) - scale(self.low))
    }
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let place = self.place(*value).clamp(-0.1, 1.1);
        limit.0 + (place * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        let most = hint.max_num_points().max(2);
        if !self.log {
            let step = self.step();
            let first = (self.low / step).ceil() as i64;
            let last = (self.high / step + 1e-9).floor() as i64;
            return (first..=last).map(|n| n as f64 * step).collect();
        }
        let [from, to] = [self.low, self.high].map(|x| libm::log10(x).round() as i32);
        let every = ((to - from) as usize).div_ceil(most.min(12)).max(1);
        let exponents = (from..=to).step_by(every).map(f64::from);
        exponents.map(|power| libm::pow(10.0, power)).collect()
    }

    fn range(&self) -> Range<f64> {
        self.low..self.high
    }
}

impl ValueFormatter<f64> for Axis {
    fn format_ext(&self, value: &f64) -> String {
        if self.log {
            format!("{value:.0e}")
        } else {
            let digits = (-libm::log10(self.step()).floor()).max(0.0) as usize;
            format!("{value:.digits$}")
        }
    }
}

pub(crate) fn linear(name: &'static str, low: f64, high: f64) -> Axis {
    Axis {
        name,
        low,
        high: if high > low { high } else { low + 1.0 },
        log: false,
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mark {
    Nothing,
    Dot,
    Ring,
    Cross,
}

#[derive(Debug, Clone)]
pub(crate) struct Series {
    /// As the legend calls it; empty: not there.
    pub(crate) name: String,
    pub(crate) colour: RGBColor,
    pub(crate) mark: Mark,
    pub(crate) joined: bool,
    pub(crate) points: Vec<(f64, f64)>,
}

impl Series {
    /// Joined points in the colour of a number; grey beyond the last.
    pub(crate) fn new(name: &str, colour: usize, mark: Mark, points: Vec<(f64, f64)>) -> Self {
        Self {
            name: name.to_owned(),
            colour: COLOURS.get(colour).copied().unwrap_or(COLOURS[0]),
            mark,
            joined: true,
            points,
        }
    }

    /// Joined points whose panel says how they are drawn.
    pub(crate) fn curve(name: &str, points: Vec<(f64, f64)>) -> Self {
        Self::new(name, 0, Mark::Nothing, points)
    }
}

#[derive(Debug, Clone)]
pub(crate) struct Panel {
    pub(crate) title: String,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    pub(crate) series: Vec<Series>,
}

impl Panel {
    pub(crate) fn new(title: &str, x: Axis, y: Axis, series: Vec<Series>) -> Self {
        Self {
            title: title.to_owned(),
            x,
            y,
            series,
        }
    }
}

pub(crate) fn percent(name: &'static str) -> Axis {
    linear(name, 0.0, 100.0)
}

pub(crate) fn panel(title: &str, x: Axis, y: Axis, curves: &[Series], mark: Mark) -> Panel {
    // Grey is for what is beside the point.
    let colours = (1..COLOURS.len()).cycle();
    let series = curves.iter().zip(colours);
    let series = series.map(|(curve, colour)| Series {
        colour: COLOURS[colour],
        mark,
        ..curve.clone()
    });
    Panel::new(title, x, y, series.collect())
}

pub(crate) fn over_windows(title: &str, curves: &[Series]) -> Panel {
    let points = curves.iter().flat_map(|curve| &curve.points);
    let x = Axis::decades("window, s", points.map(|point| point.0));
    panel(title, x, percent(""), curves, Mark::Dot)
}

/// The range of all ordinates, from zero.
pub(crate) fn top(curves: &[Series]) -> f64 {
    let points = curves.iter().flat_map(|curve| &curve.points);
    points.map(|point| point.1).fold(0.0, f64::max)
}

pub(crate) const COLOURS: [RGBColor; 8] = [
    RGBColor(110, 110, 110),
    RGBColor(0, 90, 170),
    RGBColor(200, 90, 0),
    RGBColor(0, 130, 60),
    RGBColor(150, 40, 140),
    RGBColor(190, 20, 20),
    RGBColor(130, 110, 0),
    RGBColor(0, 130, 150),
];

const WIDTH: u32 = 1000;
const PANEL_HEIGHT: u32 = 330;
const LEGEND_ROW: i32 = 22;
const LEGEND_COLUMNS: usize = 3;

/// What `draw` puts on a white picture of so many pixels.
pub(crate) fn svg(
    size: (u32, u32),
    draw: impl FnOnce(&Area<'_>) -> Result<(), Fault>,
) -> Result<String> {
    let mut svg = String::new();
    let all = |root: Area<'_>| -> Result<(), Fault> {
        root.fill(&WHITE)?;
        draw(&root)?;
        Ok(root.present()?)
    };
    let drawn = all(SVGBackend::with_string(&mut svg, size).into_drawing_area());
    drawn.map_err(|fault| anyhow!("a picture: {fault}"))?;
    Ok(svg)
}

/// Pictures of `size` pixels each in so many columns, by what draws one.
pub(crate) fn grid<T>(
    all: &[T],
    columns: usize,
    size: (u32, u32),
    draw_one: impl Fn(&T, &Area<'_>) -> Result<(), Fault>,
) -> Result<String> {
    let columns = columns.max(1);
    let rows = all.len().div_ceil(columns).max(1);
    svg((size.0 * columns as u32, size.1 * rows as u32), |root| {
        let areas = root.split_evenly((rows, columns));
        all.iter()
            .zip(areas)
            .try_for_each(|(one, area)| draw_one(one, &area))
    })
}

/// The panels, two beside each other, over one legend (that of the first).
pub(crate) fn draw(panels: &[Panel]) -> Result<String> {
    draw_in(panels.len().clamp(1, 2), panels)
}

pub(crate) fn draw_in(columns: usize, panels: &[Panel]) -> Result<String> {
    let rows = panels.len().div_ceil(columns).max(1);
    let first = panels.first().into_iter().flat_map(|panel| &panel.series);
    let legend: Vec<&Series> = first.filter(|series| !series.name.is_empty()).collect();
    let legend_height = LEGEND_ROW as u32 * (legend.len().div_ceil(LEGEND_COLUMNS) as u32) + 12;
    let height = PANEL_HEIGHT * rows as u32;
    svg((WIDTH, height + legend_height), |root| {
        let (diagrams, below) = root.split_vertically(height);
        for (panel, area) in panels.iter().zip(diagrams.split_evenly((rows, columns))) {
            draw_panel(panel, &area)?;
        }
        draw_legend(&legend, &below)
    })
}

fn draw_legend(legend: &[&Series], below: &Area<'_>) -> Result<(), Fault> {
    for (n, series) in legend.iter().enumerate() {
        let x = 40 + (n % LEGEND_COLUMNS) as i32 * (WIDTH as i32 / LEGEND_COLUMNS as i32);
        let y = 12 + (n / LEGEND_COLUMNS) as i32 * LEGEND_ROW;
        if series.joined {
            let line = [(x, y), (x + 28, y)];
            below.draw(&PathElement::new(line, series.colour.stroke_width(2)))?;
        }
        if let Some(mark) = mark(series, (x + 14, y)) {
            below.draw(&mark)?;
        }
        let font = ("sans-serif", 14).into_font();
        below.draw(&Text::new(series.name.clone(), (x + 36, y - 7), font))?;
    }
    Ok(())
}

fn mark<'b, C: Clone + 'static>(
    series: &Series,
    at: C,
) -> Option<DynElement<'static, SVGBackend<'b>, C>> {
    let colour = series.colour;
    Some(match series.mark {
        Mark::Nothing => return None,
        Mark::Dot => Circle::new(at, 4, colour.filled()).into_dyn(),
        Mark::Ring => Circle::new(at, 4, colour.stroke_width(2)).into_dyn(),
        Mark::Cross => Cross::new(at, 4, colour.stroke_width(2)).into_dyn(),
    })
}

fn draw_panel(panel: &Panel, area: &Area<'_>) -> Result<(), Fault> {
    let mut chart = ChartBuilder::on(area)
        .caption(&panel.title, ("sans-serif", 17))
        .margin(10)
        .margin_right(24)
        .x_label_area_size(42)
        .y_label_area_size(66)
        .build_cartesian_2d(panel.x.clone(), panel.y.clone())?;
    chart
        .configure_mesh()
        .light_line_style(WHITE)
        .x_desc(panel.x.name)
        .y_desc(panel.y.name)
        .draw()?;
    for series in &panel.series {
        if series.joined {
            let line = series.points.iter().copied();
            chart.draw_series(LineSeries::new(line, series.colour.stroke_width(2)))?;
        }
        let points = series.points.iter();
        chart.draw_series(points.filter_map(|point| mark(series, *point)))?;
    }
    Ok(())
}
