//! What was presented, and what was decided.

use plotters::coord::Shift;
use plotters::prelude::*;

use super::curves::{DOT, RING, Sign, plain, with_legend};
use super::{Fault, Picture, Presented, REFUSED, RIGHT, SETPOINT, TRUTH, WRONG};
use crate::decisions::{Decided, UNKNOWN, Verdict};

/// Room on the left for the names of classes and the title beside them, pixels.
pub(super) fn names_width(classes: &[String]) -> u32 {
    /// A letter of their size takes no more.
    const LETTER: usize = 8;
    let names = classes.iter().map(String::as_str).chain([UNKNOWN]);
    let longest = names.map(|name| name.chars().count()).max();
    (longest.unwrap_or(0) * LETTER + 24).clamp(64, 300) as u32
}

/// A row for each class, and one of what was unknown: grey where it was presented, a mark for each
/// decision whose colour and shape both say its worth, a ring around one of the right side.
pub(super) fn decisions<DB: DrawingBackend<ErrorType: 'static>>(
    area: &DrawingArea<DB, Shift>,
    picture: &Picture<'_>,
    (from, to): (f64, f64),
    room: (u32, u32),
) -> Result<(), Fault> {
    let classes = picture.classes.iter().map(String::as_str);
    let rows: Vec<&str> = classes.chain([UNKNOWN]).collect();
    let count = rows.len();
    let mut entries = vec![
        (Sign::Square(TRUTH), "presented"),
        (Sign::Dot(RIGHT), "decision: right"),
        (Sign::Cross(WRONG), "wrong"),
        (Sign::Triangle(REFUSED), "refused"),
    ];
    if picture.decided.iter().any(is_of_right_side) {
        entries.push((Sign::Ring(SETPOINT), "by the right side"));
    }
    let area = with_legend(area, &entries)?;
    let mut chart = ChartBuilder::on(&area)
        .margin(6)
        .x_label_area_size(40)
        .margin_right(room.1)
        .y_label_area_size(room.0)
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
        .x_label_formatter(&|t_s| plain(*t_s))
        .y_label_formatter(&name)
        .x_desc("time, s")
        .y_desc("class")
        .draw()?;
    // What the model does not know stands where the right decision does.
    let row = |label: &str| rows.iter().position(|row| *row == label);
    for Presented {
        span_s: (start, end),
        label,
    } in &picture.film.presented
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
        let at = (t_s, row as f64);
        match decided.verdict(picture.classes) {
            Verdict::Right => {
                chart.draw_series([Circle::new(at, DOT, RIGHT.filled())])?;
            }
            Verdict::Wrong => {
                chart.draw_series([Cross::new(at, DOT, WRONG.stroke_width(2))])?;
            }
            Verdict::Refused => {
                chart.draw_series([TriangleMarker::new(at, DOT + 1, REFUSED.filled())])?;
            }
        }
        if is_of_right_side(decided) {
            chart.draw_series([Circle::new(at, RING, SETPOINT.stroke_width(1))])?;
        }
    }
    Ok(())
}

fn is_of_right_side(decided: &Decided) -> bool {
    decided.place.is_some_and(|place| place.side != 0)
}
