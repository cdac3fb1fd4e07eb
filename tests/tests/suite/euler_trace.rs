//! The papers' integrator, step for step: every column of the product's trace
//! against the independent program, with the sensor's 14-bit words in the loop.

use crate::common;
use crate::reference::{Gate, Obstacle, Row, Settings, euler};

/// Largest difference of each column as a share of its full scale.
fn differences(a: &[Row], b: &[Row]) -> [f64; 5] {
    assert_eq!(a.len(), b.len());
    let mut worst = [0.0_f64; 5];
    for (a, b) in a.iter().zip(b) {
        let pairs = [
            ([a.t_s; 2], [b.t_s; 2], 1.0),
            (a.theta_deg, b.theta_deg, 100.0),
            (a.z, b.z, 1.0),
            (a.g, b.g, 2.0),
            (a.contact, b.contact, 1.0),
        ];
        for (worst, (a, b, scale)) in worst.iter_mut().zip(pairs) {
            for side in 0..2 {
                *worst = worst.max((a[side] - b[side]).abs() / scale);
            }
        }
    }
    worst
}

fn cases() -> [(&'static str, Settings); 3] {
    let gate = |gain: f64, tau_s: f64| Some(Gate { gain, tau_s });
    let obstacle = |at_deg, stiffness| Some(Obstacle { at_deg, stiffness });
    let papers = Settings {
        rcp: gate(0.7, 0.125),
        cia: gate(0.5, 0.125),
        obstacle: obstacle([100.0, 125.0], 0.1),
        quantise: true,
        ..Settings::papers()
    };
    let strong = Settings {
        gains: [vec![1.3, 0.4, 2.0], vec![0.7, 1.0, 1.9]],
        start: [[0.6, 0.5], [-0.9, 0.2]],
        rcp: gate(2.0, 0.05),
        ..papers.clone()
    };
    let fast = Settings {
        tick_hz: 4000.0,
        frequency_hz: 8.0,
        coupling: false,
        start: [[0.1, -1.2], [1.4, 1.4]],
        rcp: gate(0.9, 0.02),
        cia: gate(0.8, 0.2),
        obstacle: obstacle([90.0, 110.0], 0.02),
        ..papers.clone()
    };
    [
        ("the papers' RCP and CIA", papers),
        ("strong and fast, several whiskers, out of phase", strong),
        ("another tick, faster whisks, no coupling", fast),
    ]
}

#[test]
fn every_column_agrees_over_six_seconds() {
    for (name, settings) in cases() {
        let product = common::trace(&settings, "euler", 6.0);
        let reference = euler::run(&settings, 6.0);
        let worst = differences(&product, &reference);
        println!("{name}: t, theta, z, g, contact differ by at most {worst:?} of full scale");
        assert!(worst.iter().all(|of| *of < 3e-4), "{name}: {worst:?}");
        // Not by standing still: contact was made and gates opened.
        let mut rows = product.iter();
        assert!(rows.any(|row| row.z[0] > 0.2 && row.g[1] > 1.02), "{name}");
    }
}
