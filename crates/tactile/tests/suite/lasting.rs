//! Touches that last, as a stranger's recording of nothing else has them.

use tactile::ModelBuf;
use tactile::train::joint::Trial;

use crate::opinion::{decisions, learn, roll};

/// Samples of a touch of seconds.
const LONG: usize = 3_000;

/// One touch of so many samples, which trembles by as much.
fn lasting(amplitude: f64, seed: u64, samples: usize) -> Trial {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let mut sample = || [0; 2].map(|_| (9000.0 + amplitude * roll(&mut state)).round());
    Trial {
        samples: (0..samples).map(|_| sample()).collect(),
        touches: vec![1; samples],
        ..Trial::default()
    }
}

/// A model of twelve touches of each of these labels and amplitudes, in so many recordings; and how
/// many of these were held out.
fn trained(known: &[(&str, f64)], recordings: u64, samples: usize) -> (ModelBuf, u64) {
    let (trained, model) = learn((0..12).flat_map(|n| {
        let seeded = known.iter().zip(known.len() as u64 * n..);
        seeded.map(move |((label, amplitude), seed)| Trial {
            label: (*label).to_owned(),
            recording: (n % recordings).to_string(),
            ..lasting(*amplitude, seed, samples)
        })
    }));
    (model, trained.report.poses.len() as u64)
}

/// How often a touch is named by its class, and by another, and all that is said of it.
fn named(model: &ModelBuf, label: &str, touch: &Trial) -> [usize; 3] {
    let class = model.names().position(|name| name == label);
    let said = decisions(model, touch);
    let named = said.iter().filter_map(|(of, _)| of.class());
    let right = named.clone().filter(|of| Some(*of) == class).count();
    [right, named.count() - right, said.len()]
}

/// Where a touch lasts, each of its nine blocks is judged as those of training were: what was
/// trained is named throughout, and what was not never. An opinion alone names nothing there,
/// however many poses it is of.
#[test]
fn a_touch_that_lasts_is_judged_from_its_first_block_to_its_last() {
    let known = [("smooth", 20.0), ("middling", 60.0), ("rough", 180.0)];
    for recordings in [1, 3] {
        let (model, held_out) = trained(&known, recordings, LONG);
        assert!(model.has_opinion() && !model.names_between_poses());
        // Of several recordings each is held out, as what to expect of another.
        assert_eq!(held_out, if recordings > 1 { recordings } else { 0 });
        for ((label, amplitude), seed) in known.into_iter().zip(100..) {
            let touch = lasting(amplitude, seed, LONG);
            let [right, _, all] = named(&model, label, &touch);
            assert!(right >= 10 && 10 * right >= 9 * all, "{right} of {all}");
            // Two parts of nine blocks have ended.
            let (first, _) = decisions(&model, &touch)[0];
            assert!(first.samples() >= 2 * 9 * model.block());
        }
        // A tenth rougher: near enough for some parts by themselves, and too far in the mean.
        let unknown = |amplitude| named(&model, "", &lasting(amplitude, 200, LONG));
        let [_, wrong, all] = unknown(66.0);
        assert!(10 * wrong <= all);
        for amplitude in [35.0, 105.0, 500.0] {
            assert_eq!(unknown(amplitude)[1], 0, "{recordings}: {amplitude}");
        }
    }
}

/// A touch of little more than nine blocks is not waited for longer than it lasts.
#[test]
fn a_touch_that_lasts_a_little_is_named_before_it_ends() {
    let known = [("smooth", 20.0), ("rough", 180.0)];
    let (model, _) = trained(&known, 1, 600);
    for ((label, amplitude), seed) in known.into_iter().zip(100..) {
        let [right, ..] = named(&model, label, &lasting(amplitude, seed, 600));
        assert!(right > 0, "{label}");
    }
}

/// What would be another class at a scale that is a fifth off is not named as that one.
#[test]
fn a_sensor_that_reads_less_makes_no_other_class_of_one() {
    let known = [("soft", 40.0), ("middling", 64.0), ("rough", 80.0)];
    let (model, _) = trained(&known, 1, LONG);
    let named = |label, amplitude| named(&model, label, &lasting(amplitude, 200, LONG));
    for (label, amplitude) in known {
        for gain in [0.8, 1.2] {
            let [_, wrong, all] = named(label, gain * amplitude);
            assert!(20 * wrong <= all, "{label} {gain}: {wrong} of {all}");
        }
    }
    let [right, _, all] = named("soft", 40.0);
    assert!(10 * right >= 9 * all, "{right} of {all}");
}
