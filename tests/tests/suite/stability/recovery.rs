//! After abuse the module is as if nothing had been: the full product of
//! frequency, tick, integrator and number format, at full length.
//!
//! The criterion, for every integrator that can carry the case: three whisks
//! and six time constants of the slower gate after the abuse, and for a whisk
//! from then on, every θ' is within 0.1° of that of a module that was never
//! touched. (Muscles forget with e^-2.7 a whisk, their slower pole being
//! 10 f_W (2 − √3); a gate that closed a side wholly has lost all but 0.25 %.)
//! Where a gate takes longer than a whisk, three whisks are run and it must
//! then be where its closed form says, within 1e-4.

use rayon::prelude::*;
use whisking::{Fix, Integrator};

use super::axes::{Case, cases};
use super::rig::{Abuse, Extreme, Module, start};

const ABUSE: usize = 300;

fn run<R: Extreme>(case: Case) {
    let settings = case.settings();
    let start = start::<R>(case, &settings);
    let [mut touched, mut untouched] = [(); 2].map(|()| Module::<R>::new(&settings, &start));
    let mut abuse = Abuse::new(case.input(), case.tick_hz());
    for _ in 0..ABUSE {
        touched.tick(abuse.contact(), &case);
        untouched.tick([R::ZERO; 2], &case);
    }

    let [_, _, _, z, g] = touched.view();
    let whisk = case.tick_hz() / case.frequency_hz();
    let taus =
        [settings.rcp.unwrap().tau_s, settings.cia.unwrap().tau_s].map(|s| s * case.tick_hz());
    let slower = taus[0].max(taus[1]);
    let is_forgotten = slower <= 1.001 * whisk;
    let wait = 3.0 * whisk + if is_forgotten { 6.0 * slower } else { 0.0 };
    for _ in 0..wait as usize {
        touched.tick([R::ZERO; 2], &case);
        untouched.tick([R::ZERO; 2], &case);
    }

    if is_forgotten {
        for _ in 0..whisk.ceil() as usize {
            touched.tick([R::ZERO; 2], &case);
            untouched.tick([R::ZERO; 2], &case);
            let [_, ours, ..] = touched.view();
            let [_, theirs, ..] = untouched.view();
            for (a, b) in ours.iter().zip(theirs) {
                let degrees = 100.0 * (a - b).abs();
                assert!(degrees < 0.1, "{case:?}: {degrees} degrees");
            }
        }
    }
    // The closed forms, from the last tick of abuse.
    let ticks = wait.floor() + if is_forgotten { whisk.ceil() } else { 0.0 };
    let kept = taus.map(|tau| match settings.integrator {
        Integrator::Exact => (-ticks / tau).exp(),
        Integrator::Euler => (1.0 - 1.0 / tau).max(0.0).powf(ticks),
    });
    let [psi, _, _, found_z, found_g] = touched.view();
    let [_, _, _, _, rest_g] = untouched.view();
    for w in 0..4 {
        assert!((found_z[w] - z[w] * kept[0]).abs() < 1e-4, "{case:?}");
        let expected = rest_g[w] + (g[w] - rest_g[w]).max(0.0) * kept[1];
        assert!((found_g[w] - expected).abs() < 1e-4, "{case:?}");
    }
    // From any start the oscillators are on their way to the circle. (On the
    // way out of anti-phase their coupling holds them at half its radius.)
    for side in [[psi[0], psi[1]], [psi[2], psi[3]]] {
        let radius = side[0].hypot(side[1]);
        assert!((0.35..1.55).contains(&radius), "{case:?}: {radius}");
    }
}

/// Frequency, tick and integrator in full, where the integrator can carry the case.
#[test]
fn every_number_format_comes_back() {
    fn recovers<R: Extreme>(seed: u64) {
        let carried = cases(3, seed)
            .into_par_iter()
            .filter(|case| case.is_carried());
        carried.for_each(run::<R>);
    }
    recovers::<f64>(1);
    recovers::<f32>(2);
    recovers::<Fix>(3);
}
