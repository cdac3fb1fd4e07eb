//! The full product: 300 ticks of abuse, 300 of rest, every tick in bounds, no
//! wrap-around (ten whisks long where the sides start in anti-phase), and gates
//! that decay as their closed forms say.

use rayon::prelude::*;
use whisking::{Fix, Integrator, Settings};

use super::axes::{Case, cases};
use super::rig::{Abuse, Extreme, Module, start, widened};

const ABUSE: usize = 300;
const REST: usize = 300;

/// Largest distance of a gate from its closed form: 1e-6, which is some
/// roundings of f32.
const DECAY: f64 = 1e-6;

/// What is left of a gate after one tick of rest, by a second implementation; `None`
/// where forward Euler overshoots, and only the bounds hold.
fn kept(settings: &Settings, tau_s: f64) -> Option<f64> {
    let ticks = tau_s * settings.tick_hz;
    match settings.integrator {
        Integrator::Exact => Some((-1.0 / ticks).exp()),
        Integrator::Euler => (ticks > 0.999).then_some(1.0 - 1.0 / ticks),
    }
}

/// Runs `case` in `R`, and in f64 beside it where that must agree.
fn run<R: Extreme>(case: Case) {
    let settings = case.settings();
    let start = start::<R>(case, &settings);
    let mut module = Module::new(&settings, &start);
    // With twenty ticks a whisk and fewer fixed point limits the differences
    // of a force that jumps.
    let is_limited = R::STEP > 0.0 && case.frequency_hz() / case.tick_hz() >= 0.05;
    let mut reference = (R::ROUNDING > 0.0 && !is_limited && case.is_alike_in_all_formats())
        .then(|| Module::<f64>::new(&settings, &widened(&start)));
    let mut abuse = Abuse::new(case.input(), case.tick_hz());
    // From anti-phase the last bits decide in the end which side yields.
    let mut together = if case.is_in_phase() {
        usize::MAX
    } else {
        (10.0 * case.tick_hz() / case.frequency_hz()) as usize
    };
    let mut tick = |module: &mut Module<R>, contact: [R; 2]| {
        module.tick(contact, &case);
        together = together.saturating_sub(1);
        if let Some(reference) = reference.as_mut().filter(|_| together > 0) {
            reference.tick(contact.map(R::to_f64), &case);
            let distance = module.distance(reference);
            assert!(distance < R::ROUNDING, "{case:?}: {distance:e}");
        }
    };
    for _ in 0..ABUSE {
        let contact = abuse.contact();
        tick(&mut module, contact);
    }

    let [_, _, _, mut z, mut g] = module.view();
    let nominal = [0, 1, 2, 3].map(|n| module.state.whiskers[n].nominal().to_f64());
    let kept_z = kept(&settings, settings.rcp.unwrap().tau_s);
    let kept_g = kept(&settings, settings.cia.unwrap().tau_s);
    for _ in 0..REST {
        tick(&mut module, [R::ZERO; 2]);
        let [_, _, _, found_z, found_g] = module.view();
        for (w, nominal) in nominal.iter().enumerate() {
            if let Some(kept) = kept_z {
                z[w] *= kept;
                let found = found_z[w];
                assert!((found - z[w]).abs() < DECAY, "{case:?}: z {found} {}", z[w]);
            }
            if let Some(kept) = kept_g {
                // Without contact g is not below its nominal value (eq. 12).
                g[w] = (nominal + (g[w] - nominal) * kept).max(*nominal);
                let found = found_g[w];
                assert!((found - g[w]).abs() < DECAY, "{case:?}: g {found} {}", g[w]);
            }
        }
    }
}

#[test]
fn nothing_leaves_its_bounds_wraps_around_or_decays_otherwise() {
    cases(5, 1).into_par_iter().for_each(|case| {
        run::<f64>(case);
        run::<f32>(case);
        run::<Fix>(case);
    });
}
