//! The drawing: a section through pivot, magnet and sensor, to scale but for the whisker's length.

use std::fmt::Write as _;

use super::{
    BASE, Dimension, LENGTH, MAGNET_DIAMETER, MAGNET_LENGTH, SLEEVE, SLEEVE_LENGTH, TIP, gap,
};

/// Units of the drawing for a millimetre.
const SCALE: f64 = 18.0;
const WIDTH: f64 = 620.0;
/// The whisker's axis.
const AXIS: f64 = 230.0;
/// The magnet's centre, which is the pivot.
const PIVOT: f64 = 330.0;
/// Where the whisker's tip is.
const TIP_AT: f64 = 40.0;
const BREAK_AT: f64 = 110.0;
/// The package of the sensor, of no part's size.
const PACKAGE: [f64; 2] = [100.0, 30.0];

/// Where the parts' edges are.
struct Places {
    /// Half of the whisker's base, of its tip, of the magnet and of the sleeve across.
    base: f64,
    tip: f64,
    magnet: f64,
    sleeve: f64,
    /// Ends of the sleeve and of the magnet, from above; the plane of the Hall elements.
    sleeve_ends: [f64; 2],
    magnet_ends: [f64; 2],
    plane: f64,
}

impl Places {
    fn new() -> Self {
        let half = |dimension: Dimension| dimension.mm * SCALE / 2.0;
        let about_pivot = |dimension: Dimension| {
            let half = half(dimension);
            [PIVOT - half, PIVOT + half]
        };
        let magnet_ends = about_pivot(MAGNET_LENGTH);
        Self {
            base: half(BASE),
            tip: half(TIP),
            magnet: half(MAGNET_DIAMETER),
            sleeve: half(SLEEVE),
            sleeve_ends: about_pivot(SLEEVE_LENGTH),
            magnet_ends,
            plane: magnet_ends[1] + gap().mm * SCALE,
        }
    }
}

/// The drawing: an SVG document.
pub(in super::super) fn svg() -> String {
    let places = Places::new();
    let mut body = String::new();
    draw_parts(&mut body, &places);
    draw_dimensions(&mut body, &places);
    let height = places.plane + 90.0;
    for (up, line) in [
        (30.0, "section along the direction of whisking, in mm"),
        (
            14.0,
            "to scale, but for the whisker's length and the sensor's package",
        ),
    ] {
        text(&mut body, [20.0, height - up], line);
    }
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height:.0}\" \
         font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n{body}</svg>\n"
    )
}

fn draw_parts(body: &mut String, places: &Places) {
    let Places { plane, .. } = *places;
    let [top, sleeve_end] = places.sleeve_ends;
    let [bottom, face] = places.magnet_ends;
    // The mount: two walls round the sleeve, down to the sensor.
    let wall = [26.0, plane - top + PACKAGE[1]];
    rectangle(body, [AXIS - places.sleeve - wall[0], top], wall, "#c8ced6");
    rectangle(body, [AXIS + places.sleeve, top], wall, "#c8ced6");
    let sleeve = [2.0 * places.sleeve, sleeve_end - top];
    rectangle(body, [AXIS - places.sleeve, top], sleeve, "#f3d9b1");
    // The whisker: its base as it is, a break, its tip.
    shaft(body, [bottom, BREAK_AT], [places.base, 0.7 * places.base]);
    shaft(
        body,
        [BREAK_AT - 12.0, TIP_AT],
        [0.4 * places.base, places.tip],
    );
    text(body, [AXIS + 22.0, BREAK_AT - 2.0], "(cut)");
    let magnet = [2.0 * places.magnet, face - bottom];
    rectangle(body, [AXIS - places.magnet, bottom], magnet, "#d9534f");
    let _ = writeln!(
        body,
        "<circle cx=\"{AXIS}\" cy=\"{PIVOT}\" r=\"4\" fill=\"black\"/>"
    );
    // The sensor, with the plane of its Hall elements.
    let corner = [AXIS - PACKAGE[0] / 2.0, plane - 10.0];
    rectangle(body, corner, PACKAGE, "#333");
    dashed(body, [AXIS - 150.0, plane], [AXIS + 190.0, plane]);
    dashed(body, [AXIS, TIP_AT - 14.0], [AXIS, plane + 40.0]);
    for (at, label) in [
        ([400.0, top + 20.0], "elastic sleeve, in the mount"),
        ([400.0, PIVOT + 4.0], "magnet, and the pivot (dot)"),
        ([430.0, plane + 4.0], "plane of the Hall elements"),
        ([430.0, plane + 24.0], "sensor"),
    ] {
        text(body, at, label);
    }
}

fn draw_dimensions(body: &mut String, places: &Places) {
    let Places { plane, .. } = *places;
    let [top, sleeve_end] = places.sleeve_ends;
    let [bottom, face] = places.magnet_ends;
    // Across: the height, and half of it; along: the distance from the axis, and both ends.
    for (dimension, y, half) in [
        (BASE, top - 40.0, places.base),
        (TIP, TIP_AT - 8.0, places.tip),
        (MAGNET_DIAMETER, face + 14.0, places.magnet),
        (SLEEVE, top - 12.0, places.sleeve),
    ] {
        dimension_line(body, &dimension, [AXIS - half, y], [AXIS + half, y]);
    }
    for (dimension, right, ends) in [
        (LENGTH, -200.0, [TIP_AT, PIVOT]),
        (MAGNET_LENGTH, places.magnet + 6.0, [bottom, face]),
        (gap(), places.sleeve + 50.0, [face, plane]),
        (SLEEVE_LENGTH, -places.sleeve - 85.0, [top, sleeve_end]),
    ] {
        let x = AXIS + right;
        dimension_line(body, &dimension, [x, ends[0]], [x, ends[1]]);
    }
}

/// A piece of the whisker, with half its thickness at either end.
fn shaft(body: &mut String, [from, to]: [f64; 2], [thick, thin]: [f64; 2]) {
    let (left, right) = (AXIS - thick, AXIS + thick);
    let (thin_left, thin_right) = (AXIS - thin, AXIS + thin);
    let _ = writeln!(
        body,
        "<path d=\"M {left} {from} L {thin_left} {to} L {thin_right} {to} L {right} {from} Z\" \
         fill=\"#666\"/>"
    );
}

/// A line between two ticks, with the letter and the size beside it.
fn dimension_line(body: &mut String, dimension: &Dimension, from: [f64; 2], to: [f64; 2]) {
    let is_flat = (from[1] - to[1]).abs() < 1e-9;
    let ends = if is_flat { [0.0, 5.0] } else { [5.0, 0.0] };
    let _ = writeln!(
        body,
        "<path d=\"M {:.1} {:.1} L {:.1} {:.1}\" stroke=\"#0050a0\" fill=\"none\"/>",
        from[0], from[1], to[0], to[1]
    );
    for [x, y] in [from, to] {
        let _ = writeln!(
            body,
            "<path d=\"M {:.1} {:.1} L {:.1} {:.1}\" stroke=\"#0050a0\" fill=\"none\"/>",
            x - ends[0],
            y - ends[1],
            x + ends[0],
            y + ends[1]
        );
    }
    let Dimension { letter, mm, .. } = dimension;
    let label = format!("{letter} = {mm:.2}");
    let at = if is_flat {
        [to[0] + 6.0, to[1] + 4.0]
    } else {
        [to[0] + 6.0, f64::midpoint(from[1], to[1]) + 4.0]
    };
    text(body, at, &label);
}

fn rectangle(body: &mut String, [x, y]: [f64; 2], [width, height]: [f64; 2], fill: &str) {
    let _ = writeln!(
        body,
        "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" fill=\"{fill}\" stroke=\"black\"/>"
    );
}

fn dashed(body: &mut String, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2]) {
    let _ = writeln!(
        body,
        "<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" stroke=\"#888\" stroke-dasharray=\"6 4\"/>"
    );
}

fn text(body: &mut String, [x, y]: [f64; 2], text: &str) {
    let _ = writeln!(
        body,
        "<text x=\"{x:.1}\" y=\"{y:.1}\" stroke=\"white\" stroke-width=\"3\" \
         paint-order=\"stroke\">{text}</text>"
    );
}
