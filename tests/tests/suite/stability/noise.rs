//! The strongest noise that a scene may ask for drives the oscillators into
//! their limits and nothing out of its bounds; the papers' moves all formats alike.

use rayon::prelude::*;
use whisking::{Fix, Settings};

use super::axes::{Case, cases};
use super::rig::{Extreme, Module, start, widened};

/// The papers' σ_η. All formats take their noise from the same integers, so
/// none is far from f64. (The strongest noise throws ψ through the origin,
/// where the least difference decides the direction.)
const PAPERS: f64 = 0.005;
/// The largest σ_η.
const STRONGEST: f64 = 1.0;

fn run<R: Extreme>(case: Case, noise: f64) {
    let settings = Settings {
        noise,
        ..case.settings()
    };
    let start = start::<R>(case, &settings);
    let mut module = Module::new(&settings, &start);
    let mut reference = Module::<f64>::new(&settings, &widened(&start));
    for _ in 0..2_000 {
        module.tick([R::ZERO; 2], &case);
        reference.tick([0.0; 2], &case);
        if noise == PAPERS && case.is_alike_in_all_formats() {
            let distance = module.distance(&reference);
            assert!(distance <= R::ROUNDING, "{case:?}: {distance:e}");
        }
    }
}

#[test]
fn noise_stays_in_bounds() {
    cases(3, 1).into_par_iter().for_each(|Case(place)| {
        let [frequency, tick, integrator, ..] = place;
        // From the origin; gates are the papers', without contact.
        let case = Case([frequency, tick, integrator, 0, 1, 3, 3, 1, 1]);
        for noise in [PAPERS, STRONGEST] {
            run::<f64>(case, noise);
            run::<f32>(case, noise);
            run::<Fix>(case, noise);
        }
    });
}
