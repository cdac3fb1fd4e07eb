//! The reference program against truths from outside: the table of the paper's
//! claims, scipy's DOP853 and Butterworth design, and closed forms. Everything
//! else is tested against it.

use std::f64::consts::{PI, TAU};

use crate::common::project;
use crate::reference::butterworth::Lowpass;
use crate::reference::claims::{self, ANGLE_TOLERANCE_DEG, Claim, Figure, Quantity, RUN_S, TABLE};
use crate::reference::{Reading, Row, Settings, euler};

fn table(name: &str) -> Vec<Vec<f64>> {
    let path = project(&format!("tests/reference/{name}"));
    let text = std::fs::read_to_string(path).unwrap();
    let numbers = |line: &str| line.split(',').map(|cell| cell.parse().unwrap()).collect();
    text.lines().skip(1).map(numbers).collect()
}

fn measured(claim: &Claim, settings: &Settings) -> f64 {
    let rows = euler::run(settings, RUN_S);
    let value = claim.quantity.measure(settings, &rows);
    value.unwrap_or_else(|| panic!("{claim:?}: whisks differ"))
}

/// As they are, through the sensor's word and from another start, and with the mass as printed.
#[test]
fn every_claim_holds() {
    for claim in &TABLE {
        let plain = claim.figure.settings();
        let mut other = plain.clone();
        other.quantise = true;
        other.start = [[0.6, 0.5], [0.9, -0.2]];
        let mut misprint = plain.clone();
        misprint.reading.mass_misprint = true;
        let mut cases = vec![(plain, claim.value), (other, claim.value)];
        cases.extend(claim.misprinted.map(|value| (misprint, value)));
        for (settings, expected) in cases {
            let value = measured(claim, &settings);
            assert!(claim.is_near(value, expected), "{value} for {claim:?}");
        }
    }
}

fn largest_g(rows: &[Row]) -> f64 {
    rows.iter().map(|row| row.g[1]).fold(0.0, f64::max)
}

#[test]
fn asymmetry_as_printed_never_excites() {
    let mut settings = Figure::Fig9.settings();
    assert!(largest_g(&euler::run(&settings, RUN_S)) > 1.2);
    settings.reading.cia_misprint = true;
    let rows = euler::run(&settings, RUN_S);
    assert!((largest_g(&rows) - 1.0).abs() < 1e-15);
    let max = Quantity::MaxTheta(1).measure(&settings, &rows).unwrap();
    assert!((max - 122.9).abs() < ANGLE_TOLERANCE_DEG, "{max}");
    // The printed return is singular at g = 1: full excitation without contact.
    settings.obstacle = None;
    settings.reading = Reading {
        g_decay_misprint: true,
        ..Reading::default()
    };
    let rows = euler::run(&settings, 0.001);
    assert!((rows[0].g[1] - 2.0).abs() < 1e-15);
}

/// √((1 + ρ)² + (2π f_W T)²) = 1 with ρ = T (1 − r)/(τ_r r), solved for r.
fn euler_radius(frequency_hz: f64, tick_s: f64) -> f64 {
    let turn = TAU * frequency_hz * tick_s;
    let shrink = 1.0 - (1.0 - turn * turn).sqrt();
    let tau = 2.0 / frequency_hz;
    1.0 / (1.0 - shrink * tau / tick_s)
}

#[test]
fn euler_circles_too_wide_as_its_closed_form_says() {
    for (frequency_hz, about) in [(2.0, 1.04), (10.0, 1.25)] {
        let mut settings = Settings::papers();
        settings.frequency_hz = frequency_hz;
        let mut module = euler::Module::new(&settings);
        for _ in 0..40_000 {
            module.tick();
        }
        let [p, q] = module.psi()[0];
        let expected = euler_radius(frequency_hz, settings.tick_s());
        assert!((p.hypot(q) - expected).abs() < 1e-9, "{frequency_hz}");
        assert!((expected - about).abs() < 0.005, "{expected}");
    }
}

/// Against scipy's DOP853.
#[test]
fn euler_errs_as_published() {
    let cases = [
        (2.0, 2000.0, 0.48, 0.005),
        (8.0, 2000.0, 1.93, 0.005),
        (25.0, 2000.0, 5.7, 0.05),
        (25.0, 500.0, 51.0, 0.5),
    ];
    for (frequency_hz, tick_hz, published, digits) in cases {
        let settings = Settings {
            frequency_hz,
            tick_hz,
            start: [[1.0, 0.0], [0.6, 0.5]],
            ..Settings::papers()
        };
        let rows = euler::run(&settings, 10.0 / frequency_hz);
        // Ticks of 2 kHz, of which every fourth is one of 500 Hz.
        let exact = table(&format!("whisk_{frequency_hz}hz.csv"));
        let every = 2000.0 / tick_hz;
        let compared = exact.iter().filter(|exact| exact[0] % every == 0.0);
        let differences = compared.flat_map(|exact| {
            let row = rows[(exact[0] / every) as usize - 1];
            [0, 1].map(|side: usize| (row.theta_deg[side] - exact[1 + side]).abs())
        });
        let worst = differences.fold(0.0, f64::max);
        assert!((worst - published).abs() <= digits, "{worst}");
    }
}

/// Averaged over a whisk, the phase difference obeys dδ/dt = −sin(δ)/(2 T_W), so
/// that tan(δ/2) falls with the time constant 2 T_W.
#[test]
fn sides_lock_within_two_whisks() {
    for start_rad in [0.2_f64, 0.8, -1.5] {
        let mut settings = Settings::papers();
        settings.start = [[1.0, 0.0], [start_rad.cos(), start_rad.sin()]];
        let mut module = euler::Module::new(&settings);
        // Four whisks, 2 s.
        for _ in 0..4000 {
            module.tick();
        }
        let [left, right] = module.psi().map(|[p, q]| q.atan2(p));
        let difference = (right - left + PI).rem_euclid(TAU) - PI;
        let fall = (start_rad / 2.0).tan() / (difference / 2.0).tan();
        let tau_in_whisks = 4.0 / fall.ln();
        assert!((tau_in_whisks - 2.0).abs() < 0.01, "{tau_in_whisks}");
    }
}

#[test]
fn butterworth_agrees_with_scipy() {
    for row in table("butterworth.csv") {
        let filter = Lowpass::new(50.0, row[0]);
        for (ours, scipy) in filter.b.iter().chain(&filter.a).zip(&row[1..]) {
            let bound = 1e-12 * scipy.abs().max(1e-3);
            assert!((ours - scipy).abs() < bound, "{}", row[0]);
        }
    }
    let mut filter = Lowpass::new(50.0, 2000.0);
    for row in table("butterworth_step.csv") {
        assert!((filter.step(1.0) - row[0]).abs() < 1e-12);
    }
}

#[test]
fn measures_count_what_they_say() {
    let wave =
        |n: f64| (0..=1000).map(move |k| 10.0 - 10.0 * (TAU * f64::from(k) * n / 1000.0).cos());
    assert_eq!(claims::peaks(wave(1.0)), 1);
    assert_eq!(claims::peaks(wave(3.0)), 3);
    assert_eq!(claims::peaks(wave(3.0).map(|angle| 0.02 * angle)), 0);
    assert_eq!(claims::contacts([0.0, 0.06, 0.03, 0.06, 0.01, 0.2, 0.0]), 2);
    let text = "t_s,extra,theta_left_deg,theta_right_deg,z_left,z_right,g_left,g_right,\
                contact_left,contact_right\n0.5,9,1,2,3,4,5,6,7,8\n";
    let row = claims::read_trace(text).unwrap()[0];
    assert_eq!((row.t_s, row.theta_deg), (0.5, [1.0, 2.0]));
    assert_eq!(row.contact, [7.0, 8.0]);
    let fault = claims::read_trace(&text.replace(",8", ",x")).unwrap_err();
    assert!(fault.contains("line 2"), "{fault}");
}
