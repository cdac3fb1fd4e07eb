//! One set of equations, three number formats: the same module, the same
//! behaviour.

use crate::common;
use acceptance::claims::Figure;
use acceptance::reference::Row;

/// Largest difference of θ' over a run, degrees.
fn apart(a: &[Row], b: &[Row]) -> f64 {
    assert_eq!(a.len(), b.len());
    let pairs = a
        .iter()
        .zip(b)
        .flat_map(|(a, b)| a.theta_deg.into_iter().zip(b.theta_deg));
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn free_whisking_is_the_same_to_a_fraction_of_a_thousandth_of_a_degree() {
    let mut settings = Figure::Fig6(1.0).settings();
    settings.start = [[1.0, 0.0], [0.6, 0.5]];
    let double = common::trace_in("f64", &settings, 5.0);
    for (format, within) in [("f32", 1e-4), ("fixed", 3e-4)] {
        let difference = apart(&double, &common::trace_in(format, &settings, 5.0));
        println!("free whisking in {format}: {difference:e} degrees from f64");
        assert!(difference < within, "{format}: {difference:e}");
    }
}

/// In contact the sensor's steps of 1/8191 decide: a rounding may take one the
/// other way, and the whisk answers to that.
#[test]
fn whisking_against_obstacles_is_the_same_to_the_sensors_steps() {
    for figure in [Figure::Fig7, Figure::Fig8, Figure::Fig9] {
        let settings = figure.settings();
        let double = common::trace_in("f64", &settings, 5.0);
        for format in ["f32", "fixed"] {
            let difference = apart(&double, &common::trace_in(format, &settings, 5.0));
            println!("{figure:?} in {format}: {difference:e} degrees from f64");
            assert!(difference < 1e-3, "{figure:?} {format}: {difference:e}");
        }
    }
}
