//! Every row of the claims table by the product: firmware tick, sensor words
//! on the bus and all. And where a misprint fails a claim, the product with
//! that one constant misprinted fails it too.

use crate::common;
use acceptance::claims::{Claim, Figure, Quantity, RUN_S, TABLE};
use acceptance::reference::{Row, Settings};
use whisking::gate::Gate;
use whisking::{GateSettings, Integrator, State, degrees, filter, gate, muscle};

fn measure(claim: &Claim, settings: &Settings, rows: &[Row]) -> f64 {
    claim
        .quantity
        .measure(settings, rows)
        .unwrap_or_else(|| panic!("{claim:?}: whisks differ"))
}

#[test]
fn every_claim_holds() {
    for claim in &TABLE {
        let settings = claim.figure.settings();
        let rows = common::trace(&settings, "euler", RUN_S);
        let value = measure(claim, &settings, &rows);
        assert!(claim.is_near(value, claim.value), "{value} for {claim:?}");
    }
}

/// With the exact integrator the claims' words still hold, though the figures
/// are those of an oscillator that sits on its circle.
#[test]
fn the_claims_in_words_hold_with_the_exact_integrator() {
    let run = |figure: Figure| {
        let settings = figure.settings();
        let rows = common::trace(&settings, "exact", RUN_S);
        move |quantity: Quantity| quantity.measure(&settings, &rows).unwrap()
    };
    let tops: Vec<f64> = [0.5, 1.0, 1.5, 2.0]
        .map(|g| run(Figure::Fig6(g))(Quantity::MaxTheta(0)))
        .to_vec();
    assert!(
        tops.is_sorted() && tops[3] < 150.0,
        "higher g, higher θ', never unity: {tops:?}"
    );
    let (fig7, fig8, fig9) = (run(Figure::Fig7), run(Figure::Fig8), run(Figure::Fig9));
    assert!(
        fig7(Quantity::MaxTheta(0)) < tops[1] - 10.0,
        "the left is suppressed"
    );
    assert!(
        (fig7(Quantity::MaxTheta(1)) - tops[1]).abs() < 1e-3,
        "the right is not"
    );
    assert_eq!(fig8(Quantity::PeaksPerWhisk(0)), 2.0);
    assert_eq!(fig8(Quantity::ContactsPerWhisk(0)), 2.0);
    assert_eq!(
        fig9(Quantity::ContactsPerWhisk(1)),
        1.0,
        "the right finds its obstacle"
    );
}

/// How g − 1 of a whisker follows the array's contact ζ.
type Excite = fn(Option<gate::Cia<f64>>, &mut Gate<f64>, f64);

/// Eqs. 12 and 13 as mended: the product's.
fn mended(cia: Option<gate::Cia<f64>>, lift: &mut Gate<f64>, zeta: f64) {
    if let Some(cia) = cia {
        cia.step(lift, 1.0, zeta);
    }
}

/// Eq. 12 as printed: lifted to σ_g ζ, not to nominal + σ_g ζ.
fn printed(cia: Option<gate::Cia<f64>>, lift: &mut Gate<f64>, zeta: f64) {
    if let Some(cia) = cia {
        let returned = 1.0 + lift.value * (1.0 - cia.decay.tick);
        let g = returned.max(cia.gain * zeta).clamp(0.0, 2.0);
        *lift = Gate::new(g - 1.0);
    }
}

/// Eq. 13 as printed: g* = g + T/(τ_g (1 − g)).
fn printed_return(cia: Option<gate::Cia<f64>>, lift: &mut Gate<f64>, zeta: f64) {
    if let Some(cia) = cia {
        let g = 1.0 + lift.value;
        let returned = g + cia.decay.tick / (1.0 - g);
        let g = returned.max(1.0 + cia.gain * zeta).clamp(0.0, 2.0);
        *lift = Gate::new(g - 1.0);
    }
}

/// The product's equations in f64 with one of them as `mass` and `excite` say,
/// against the obstacles of the figure.
fn whisk(settings: &Settings, mass: f64, excite: Excite) -> Vec<Row> {
    let gate = |gate: acceptance::reference::Gate| GateSettings {
        gain: gate.gain,
        tau_s: gate.tau_s,
    };
    let product = whisking::Settings {
        tick_hz: settings.tick_hz,
        frequency_hz: settings.frequency_hz,
        integrator: Integrator::Euler,
        coupling: settings.coupling,
        noise: 0.0,
        rcp: settings.rcp.map(gate),
        cia: settings.cia.map(gate),
    };
    let mut config = product.build::<f64>().unwrap();
    let cia = config.cia.take();
    let tick_s = settings.tick_s();
    config.muscle = muscle::Config::Euler(muscle::Euler {
        spring: tick_s / mass.sqrt(),
        damping: tick_s * 4.0 / mass.sqrt(),
    });
    let gain = [settings.gains[0][0], settings.gains[1][0]];
    let start = product.start(&settings.start, &gain.each_ref().map(std::slice::from_ref));
    let mut state = State::new(&start.unwrap(), 1);
    let h50 = filter::Config::<f64>::new(50.0, settings.tick_hz).unwrap();
    let mut filters = [filter::State::default(); 2];
    let mut theta_deg = [50.0; 2];
    let mut lifts = [Gate::default(); 2];
    (1..=(RUN_S * settings.tick_hz) as usize)
        .map(|n| {
            let mut contact = [0.0; 2];
            if let Some(obstacle) = settings.obstacle {
                for side in 0..2 {
                    let overlap = theta_deg[side] - obstacle.at_deg[side];
                    let x = (obstacle.stiffness * overlap.max(0.0)).min(1.0);
                    contact[side] = h50.process(&mut filters[side], x).abs();
                }
            }
            let zeta = contact[0].max(contact[1]);
            // In place of CIA, which the product does not have here.
            let whiskers = state.whiskers.iter_mut().zip(&mut lifts).zip(&gain);
            for ((whisker, lift), nominal) in whiskers {
                excite(cia, lift, zeta);
                whisker.set_nominal(nominal + lift.mean);
            }
            config.step(&mut state, &contact);
            theta_deg = [0, 1].map(|side| degrees(state.whiskers[side].muscle.theta));
            Row {
                t_s: n as f64 * tick_s,
                theta_deg,
                z: [0, 1].map(|side| state.sides[side].z.value),
                g: [0, 1].map(|side| state.whiskers[side].gain()),
                contact,
            }
        })
        .collect()
}

#[test]
fn the_misprinted_mass_fails_the_claims_it_fails_on_paper() {
    let mut separated = 0;
    for claim in &TABLE {
        let settings = claim.figure.settings();
        let right = 1.0 / (settings.frequency_hz * settings.frequency_hz) / 100.0;
        let wrong = settings.frequency_hz * settings.frequency_hz / 100.0;
        let value = measure(claim, &settings, &whisk(&settings, right, mended));
        assert!(
            claim.is_near(value, claim.value),
            "as mended, {value} for {claim:?}"
        );
        let Some(expected) = claim.misprinted else {
            continue;
        };
        let value = measure(claim, &settings, &whisk(&settings, wrong, mended));
        assert!(
            claim.is_near(value, expected),
            "as printed, {value} for {claim:?}"
        );
        if expected != claim.value {
            assert!(!claim.is_near(value, claim.value), "{value} for {claim:?}");
            separated += 1;
        }
    }
    assert!(separated >= 8, "{separated} rows separate the misprint");
}

#[test]
fn the_misprinted_excitation_does_not_find_the_right_obstacle() {
    let settings = Figure::Fig9.settings();
    for (excite, expected) in [(mended as Excite, 1.0), (printed, 0.0)] {
        let rows = whisk(&settings, settings.mass(), excite);
        let contacts = Quantity::ContactsPerWhisk(1).measure(&settings, &rows);
        assert_eq!(contacts, Some(expected));
    }
}

#[test]
fn the_misprinted_return_never_rests_at_the_nominal_gain() {
    let settings = Settings {
        obstacle: None,
        ..Figure::Fig9.settings()
    };
    for (excite, rests) in [(mended as Excite, true), (printed_return, false)] {
        let rows = whisk(&settings, settings.mass(), excite);
        let mut steady = rows.iter().rev().take(5_000);
        assert_eq!(steady.all(|row| (row.g[0] - 1.0).abs() < 5e-4), rests);
    }
}
