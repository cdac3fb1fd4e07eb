//! The work-precision diagram: bytes against error, all variants.

use super::super::chart::{Axis, COLOURS, Mark, Panel, Series, draw};
use super::super::page::short;
use super::ground::LEAST_POSTERIOR;
use super::measure::{Row, Study};
use super::model::{Deficit, Entry, Exponential, Variant};
use super::text::bytes;
use host_sim::Error;

/// Draws it as SVG.
///
/// # Errors
/// [`Error::Work`] if the drawing library fails.
pub(super) fn work_precision(study: &Study) -> Result<String, Error> {
    let leader = |row: &Row| row.errors.leader.largest;
    let every = |row: &Row| row.errors.all.largest;
    draw(&[
        panel(study, "the leading class", leader),
        panel(
            study,
            &format!("every class above {}", short(LEAST_POSTERIOR)),
            every,
        ),
    ])
}

/// Constants and state, kilobytes.
fn kilobytes(study: &Study, variant: Option<Variant>) -> f64 {
    let bytes: usize = bytes(study, variant).iter().sum();
    bytes as f64 / 1000.0
}

fn panel(study: &Study, of: &str, error: fn(&Row) -> f64) -> Panel {
    let point = |row: &Row| (kilobytes(study, row.variant), error(row));
    let mut series = Vec::new();
    for (exponential, colour) in Exponential::ALL.into_iter().zip(COLOURS) {
        for deficit in Deficit::ALL {
            let points = Entry::ALL.into_iter().filter_map(|entry| {
                study.of(Variant {
                    entry,
                    deficit,
                    exponential,
                })
            });
            let mut points: Vec<(f64, f64)> = points.map(point).collect();
            // The product's entries are as many bytes as full ones: a line
            // straight down ends it.
            points.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.total_cmp(&a.1)));
            let (mark, joined) = match deficit {
                Deficit::Bits16 => (Mark::Ring, false),
                Deficit::Bits32 => (Mark::Dot, true),
                Deficit::Bits64 => (Mark::Nothing, true),
            };
            series.push(Series {
                name: format!("{}, {} bits", exponential.name(), deficit.bits()),
                colour,
                mark,
                joined,
                points,
            });
        }
    }
    let product = Series {
        name: "the product".to_owned(),
        colour: COLOURS[5],
        mark: Mark::Ring,
        joined: false,
        points: vec![point(&study.product)],
    };
    series.push(product);
    let points = || series.iter().flat_map(|series| &series.points);
    let widest = points().map(|point| point.0).fold(0.0, f64::max);
    Panel {
        title: format!("Largest |Δ ln p| of {of}"),
        x: Axis {
            name: "constants and state, kB",
            low: 0.0,
            high: (widest * 2.0).ceil() / 2.0,
            log: false,
        },
        y: Axis::decades("|Δ ln p|", points().map(|point| point.1)),
        series,
    }
}
