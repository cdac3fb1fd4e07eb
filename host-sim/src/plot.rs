//! A picture of a run: position, contact and what was decided.

use plotters::prelude::*;

use crate::decisions::Decided;
use crate::trace::Row;

/// A decision and when it fell, s.
#[derive(Debug, Clone)]
pub struct Mark {
    /// When.
    pub t_s: f64,
    /// What.
    pub decided: Decided,
}

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;
type Fault = Box<dyn std::error::Error>;

const SIZE: (u32, u32) = (1000, 640);
const SHOULD: RGBColor = RGBColor(150, 150, 150);
const IS: RGBColor = RGBColor(0, 90, 170);
const CONTACT: RGBColor = RGBColor(200, 90, 0);
const RIGHT: RGBColor = RGBColor(0, 130, 60);
const WRONG: RGBColor = RGBColor(190, 20, 20);

/// The left whisker over `rows` as an SVG document: where it should be and is,
/// what the sensor felt, contact and suppression, and the decisions below.
///
/// # Errors
/// If the drawing library fails.
pub fn left_whisker(title: &str, rows: &[Row], marks: &[Mark]) -> Result<String, Fault> {
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        let root = root.titled(title, ("sans-serif", 20))?;
        let areas = root.split_evenly((3, 1));
        let [angle, sensor, contact] = areas.as_slice() else {
            return Err("the drawing area does not split".into());
        };
        let span = (
            rows.first().map_or(0.0, |row| row.t_s),
            rows.last().map_or(1.0, |row| row.t_s),
        );
        let left = |value: fn(&Row) -> f64| rows.iter().map(move |row| (row.t_s, value(row)));
        panel(
            angle,
            "degrees",
            span,
            (40.0, 140.0),
            None,
            vec![
                ("should be", SHOULD, left(|row| row.theta_deg[0]).collect()),
                ("is", IS, left(|row| row.angle_deg[0]).collect()),
            ],
        )?;
        panel(
            sensor,
            "x, codes",
            span,
            (4000.0, 12_400.0),
            None,
            vec![("x", IS, left(|row| row.x[0]).collect())],
        )?;
        panel(
            contact,
            "contact",
            span,
            (-0.35, 1.0),
            Some(marks),
            vec![
                ("contact", CONTACT, left(|row| row.contact[0]).collect()),
                ("z", SHOULD, left(|row| row.z[0]).collect()),
            ],
        )?;
        root.present()?;
    }
    Ok(svg)
}

type Curve = (&'static str, RGBColor, Vec<(f64, f64)>);

fn panel(
    area: &Area<'_>,
    unit: &str,
    (from, to): (f64, f64),
    (low, high): (f64, f64),
    marks: Option<&[Mark]>,
    curves: Vec<Curve>,
) -> Result<(), Fault> {
    let mut chart = ChartBuilder::on(area)
        .margin(6)
        .x_label_area_size(28)
        .y_label_area_size(58)
        .build_cartesian_2d(from..to, low..high)?;
    chart
        .configure_mesh()
        .light_line_style(WHITE)
        .x_desc("s")
        .y_desc(unit)
        .draw()?;
    for (name, colour, points) in curves {
        chart
            .draw_series(LineSeries::new(points, colour.stroke_width(1)))?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], colour));
    }
    for mark in marks
        .unwrap_or_default()
        .iter()
        .filter(|mark| (from..=to).contains(&mark.t_s))
    {
        let right = mark.decided.label == mark.decided.decision;
        let colour = if right { RIGHT } else { WRONG };
        chart.draw_series([PathElement::new(
            [(mark.t_s, -0.12), (mark.t_s, 0.0)],
            colour,
        )])?;
        chart.draw_series([Text::new(
            mark.decided.decision.clone(),
            (mark.t_s, -0.15),
            ("sans-serif", 12).into_font().color(&colour),
        )])?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE.mix(0.8))
        .draw()?;
    Ok(())
}
