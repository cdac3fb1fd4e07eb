//! What a whisker has done, as a picture.

use host_sim::plot::{Ink, Strip, Strips};

use crate::sample::Sample;

/// A chart: quantity and unit, what its axis spans at least, and its curves.
pub(crate) type Panel = (&'static str, f64, &'static [Curve]);

/// Its name, how it is drawn, and what it is of.
pub(crate) type Curve = (&'static str, Ink, fn(&Sample) -> f64);

pub(crate) const ANGLE: Panel = (
    "angle θ′, degrees",
    10.0,
    &[
        ("setpoint", Ink::Wanted, |s| s.setpoint_deg),
        ("measured", Ink::Found, |s| s.measured_deg),
    ],
);

/// Samples that are further apart are not joined by a line, s.
const GAP_S: f64 = 0.05;

pub(crate) fn picture(title: String, samples: &[Sample], panels: &[Panel]) -> Strips {
    let points = |of: fn(&Sample) -> f64| {
        let pieces = samples.chunk_by(|a, b| b.t_s - a.t_s < GAP_S);
        let points = pieces.map(|piece| piece.iter().map(|s| (s.t_s, of(s))).collect::<Vec<_>>());
        points.collect::<Vec<_>>().join(&(f64::NAN, f64::NAN))
    };
    let curve = |(name, ink, of): &Curve| (*name, *ink, points(*of));
    let strip = |(y, least, curves): &Panel| Strip {
        y,
        least: *least,
        curves: curves.iter().map(curve).collect(),
    };
    Strips {
        title,
        strips: panels.iter().map(strip).collect(),
    }
}
