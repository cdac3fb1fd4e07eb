//! The first whiskers of a run: setpoint and true angle, what the sensors felt, contact
//! and suppression, and each decision against what was presented.

use plotters::coord::Shift;
use plotters::prelude::*;

use super::curves::{Axes, Curve, Stroke, curves, entries, envelope, range, with_legend};
use super::decided::{decisions, names_width};
use super::{Fault, MEASURED, OTHER, Picture, SETPOINT, SIZE, png_of, svg_of};
use crate::Error;
use crate::trace::Row;

/// What is grey on the left side, on the right one.
const PALE: RGBColor = RGBColor(225, 190, 160);

impl Picture<'_> {
    /// As an SVG document.
    ///
    /// # Errors
    /// [`Error::Work`] if the drawing library fails.
    pub fn svg(&self) -> Result<String, Error> {
        svg_of(SIZE, |root| self.drawn(root))
    }

    /// As a PNG file.
    ///
    /// # Errors
    /// [`Error::Work`] if the drawing library fails.
    pub fn png(&self) -> Result<Vec<u8>, Error> {
        png_of(SIZE, |root| self.drawn(root))
    }

    fn drawn<DB: DrawingBackend<ErrorType: 'static>>(
        &self,
        root: &DrawingArea<DB, Shift>,
    ) -> Result<(), Fault> {
        root.fill(&WHITE)?;
        let root = root.titled(self.title, ("sans-serif", 20))?;
        let classifies = !self.classes.is_empty();
        let areas = root.split_evenly((3 + usize::from(classifies), 1));
        let [angle, sensor, contact, classes @ ..] = areas.as_slice() else {
            return Err("the drawing area does not split".into());
        };
        let rows = &self.film.rows;
        let span = (
            rows.first().map_or(0.0, |row| row.t_s),
            rows.last().map_or(1.0, |row| row.t_s),
        );
        let time = "time, s";
        // As wide in all panels: time is above time.
        let left = if classifies {
            names_width(self.classes)
        } else {
            64
        };
        let room = (left, 16);
        for (area, y, x, least, shown) in [
            (angle, "angle θ′, degrees", None, 20.0, ANGLES),
            (sensor, "sensor, codes", None, 400.0, SENSORS),
            (
                contact,
                "contact π, z",
                Some(time).filter(|_| !classifies),
                1.0,
                CONTACTS,
            ),
        ] {
            let shown = of_sides(rows, &shown);
            let area = with_legend(area, &entries(&shown))?;
            let axes = Axes { x, y, room };
            curves(&area, axes, span, range(&shown, least), shown)?;
        }
        if let [classes] = classes {
            decisions(classes, self, span, room)?;
        }
        Ok(root.present()?)
    }
}

/// A quantity of each side: its names, its colours and where it is in a row.
type Quantity = ([&'static str; 2], [RGBColor; 2], fn(&Row) -> [f64; 2]);

const STRONG: [RGBColor; 2] = [MEASURED, OTHER];
const FAINT: [RGBColor; 2] = [SETPOINT, PALE];

const ANGLES: [Quantity; 2] = [
    (["setpoint", "setpoint, right"], FAINT, |row| row.theta_deg),
    (["angle", "angle, right"], STRONG, |row| row.angle_deg),
];
const SENSORS: [Quantity; 2] = [
    (["y", "y, right"], FAINT, |row| row.y),
    (["x", "x, right"], STRONG, |row| row.x),
];
const CONTACTS: [Quantity; 2] = [
    (["contact π", "contact π, right"], STRONG, |row| {
        row.contact
    }),
    (["suppression z", "suppression z, right"], FAINT, |row| {
        row.z
    }),
];

fn of_sides(rows: &[Row], quantities: &[Quantity]) -> Vec<Curve> {
    let has_right = rows.first().is_some_and(|row| !row.angle_deg[1].is_nan());
    let sides = 0..1 + usize::from(has_right);
    let curve = |side: usize| {
        quantities.iter().map(move |(names, colours, of)| {
            let points = envelope(rows, |row| of(row)[side]);
            (names[side], Stroke::Whole(colours[side]), points)
        })
    };
    sides.flat_map(curve).collect()
}
