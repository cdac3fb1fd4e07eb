//! A picture of what both sides do: a panel a run.

use plotters::coord::Shift;
use plotters::prelude::*;

use super::curves::{Axes, Curve, Stroke, curves, entries, envelope, with_legend};
use super::{Fault, MEASURED, OTHER, svg_of};
use crate::Error;
use crate::trace::Row;

const SIDES: [Stroke; 2] = [Stroke::Whole(MEASURED), Stroke::Whole(OTHER)];
const OBSTACLES: [Stroke; 2] = [Stroke::Dashed(MEASURED), Stroke::Dashed(OTHER)];
/// Height of a panel, and width of the picture, pixels.
const PANEL: (u32, u32) = (1000, 230);

/// A run to be shown.
#[derive(Debug)]
pub struct Panel {
    /// What it shows.
    pub title: String,
    /// Its ticks.
    pub rows: Vec<Row>,
    /// Where the obstacle of each side is, degrees.
    pub obstacle_deg: [f64; 2],
}

/// Both sides of each run as an SVG document: true angles, and obstacles as dashed lines
/// in the colour of their side.
///
/// # Errors
/// [`Error::Work`] if the drawing library fails.
pub fn sides(panels: &[Panel]) -> Result<String, Error> {
    svg_of((PANEL.0, PANEL.1 * panels.len() as u32), |root| {
        root.fill(&WHITE)?;
        for (area, panel) in root.split_evenly((panels.len(), 1)).iter().zip(panels) {
            draw(area, panel)?;
        }
        Ok(root.present()?)
    })
}

fn draw(area: &DrawingArea<SVGBackend<'_>, Shift>, panel: &Panel) -> Result<(), Fault> {
    let rows = &panel.rows;
    let span = (0.0, rows.last().map_or(1.0, |row| row.t_s));
    let obstacle = |name, side: usize| -> Curve {
        let at = panel.obstacle_deg[side];
        (name, OBSTACLES[side], vec![(span.0, at), (span.1, at)])
    };
    let shown = vec![
        obstacle("obstacle, left", 0),
        obstacle("obstacle, right", 1),
        ("left", SIDES[0], envelope(rows, |row| row.angle_deg[0])),
        ("right", SIDES[1], envelope(rows, |row| row.angle_deg[1])),
    ];
    let area = area.titled(&panel.title, ("sans-serif", 18))?;
    let (x, y, room) = (Some("time, s"), "angle θ′, degrees", (64, 6));
    let axes = Axes { x, y, room };
    let area = with_legend(&area, &entries(&shown))?;
    curves(&area, axes, span, (40.0, 150.0), shown)
}
