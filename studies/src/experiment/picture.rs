//! The pictures of the experiments.

use super::page::Section;
use crate::accuracy::chart::{Axis, COLOURS, Mark, Panel, Series, draw};
use host_sim::Error;

/// The folder of pictures beside the page.
pub(super) const FOLDER: &str = "experiments";

/// Draws panels as a picture of the section.
///
/// # Errors
/// [`Error::Work`] if the drawing library fails.
pub(super) fn place(
    section: &mut Section,
    name: &str,
    what: &str,
    panels: &[Panel],
) -> Result<(), Error> {
    let svg = draw(panels)?;
    section.page.picture_in(FOLDER, name, what, svg);
    Ok(())
}

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

/// A linear axis.
pub(super) fn linear(name: &'static str, low: f64, high: f64) -> Axis {
    Axis {
        name,
        low,
        high: if high > low { high } else { low + 1.0 },
        log: false,
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

/// Panels of hit rates against a window in seconds.
pub(super) fn windows(panels: &[(String, Vec<Curve>)]) -> Result<String, Error> {
    let panels: Vec<Panel> = panels
        .iter()
        .map(|(title, curves)| {
            let points = curves.iter().flat_map(|curve| &curve.points);
            let x = Axis::decades("window, s", points.map(|point| point.0));
            panel(title, x, percent(""), curves, Mark::Dot)
        })
        .collect();
    draw(&panels)
}

/// The range of all ordinates, from zero.
pub(super) fn top(curves: &[Curve]) -> f64 {
    let points = curves.iter().flat_map(|curve| &curve.points);
    points.map(|point| point.1).fold(0.0, f64::max)
}
