//! The pictures of the experiments.

use crate::chart::{Axis, COLOURS, Mark, Panel, Series, linear};

/// A named curve.
#[derive(Debug, Clone)]
pub(super) struct Curve {
    pub(super) name: String,
    pub(super) points: Vec<(f64, f64)>,
}

impl Curve {
    pub(super) fn new(name: &str, points: Vec<(f64, f64)>) -> Self {
        Self {
            name: name.to_owned(),
            points,
        }
    }
}

/// A percentage.
pub(super) fn percent(name: &'static str) -> Axis {
    linear(name, 0.0, 100.0)
}

/// A diagram of joined points.
pub(super) fn panel(title: &str, x: Axis, y: Axis, curves: &[Curve], mark: Mark) -> Panel {
    // Grey is for what is beside the point.
    let colours = (1..COLOURS.len()).cycle();
    let series = curves.iter().zip(colours);
    Panel {
        title: title.to_owned(),
        x,
        y,
        series: series
            .map(|(curve, colour)| Series::new(&curve.name, colour, mark, curve.points.clone()))
            .collect(),
    }
}

/// Hit rates against a window in seconds.
pub(super) fn windows(title: &str, curves: &[Curve]) -> Panel {
    let points = curves.iter().flat_map(|curve| &curve.points);
    let x = Axis::decades("window, s", points.map(|point| point.0));
    panel(title, x, percent(""), curves, Mark::Dot)
}

/// The range of all ordinates, from zero.
pub(super) fn top(curves: &[Curve]) -> f64 {
    let points = curves.iter().flat_map(|curve| &curve.points);
    points.map(|point| point.1).fold(0.0, f64::max)
}
