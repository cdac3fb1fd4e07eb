//! Touches that last, as a stranger's recording of nothing else has them.

use tactile::train::joint::{Options, Trial, train};

use crate::opinion::{decisions, roll};

/// One touch of seconds, which trembles by as much.
fn lasting(label: &str, amplitude: f64, seed: u64) -> Trial {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let mut sample = || [0; 2].map(|_| (9000.0 + amplitude * roll(&mut state)).round());
    let samples: Vec<[f64; 2]> = (0..3_000).map(|_| sample()).collect();
    Trial {
        label: label.to_owned(),
        recording: String::from("lasting"),
        pose: None,
        stands: None,
        touches: vec![1; samples.len()],
        samples,
    }
}

/// Where a touch lasts, each of its nine blocks is judged as those of training were: what was
/// trained is named throughout, and what was not never. An opinion alone names nothing there,
/// however many poses it is of.
#[test]
fn a_touch_that_lasts_is_judged_from_its_first_block_to_its_last() {
    let known = [("smooth", 20.0), ("middling", 60.0), ("rough", 180.0)];
    for recordings in [1, 3] {
        let trials = (0..12).flat_map(|n| {
            let seeded = known.iter().zip(3 * n..);
            seeded.map(move |((label, amplitude), seed)| Trial {
                recording: (n % recordings).to_string(),
                ..lasting(label, *amplitude, seed)
            })
        });
        let trained = train(&trials.collect::<Vec<_>>(), &Options::default()).unwrap();
        let model = trained.model().unwrap();
        assert!(model.has_opinion() && !model.names_between_poses());
        // Of several recordings each is held out, as what to expect of another.
        let held_out = trained.report.poses.len() as u64;
        assert_eq!(held_out, if recordings > 1 { recordings } else { 0 });
        for ((label, amplitude), seed) in known.iter().zip(100..) {
            let class = model.names().position(|name| name == *label);
            let said = decisions(&model, &lasting(label, *amplitude, seed));
            let named = said.iter().filter(|(of, _)| of.class() == class).count();
            assert!(named >= 10 && 10 * named >= 9 * said.len(), "{named}");
            // Two parts of nine blocks have ended.
            let (first, _) = said.first().unwrap();
            assert!(first.samples() >= 2 * 9 * model.block());
        }
        // A tenth rougher: near enough for some parts by themselves, and too far in the mean.
        let said = decisions(&model, &lasting("", 66.0, 200));
        let named = said.iter().filter(|(of, _)| of.class().is_some());
        assert!(10 * named.count() <= said.len());
        for amplitude in [35.0, 105.0, 500.0] {
            let said = decisions(&model, &lasting("", amplitude, 200));
            let named = said.iter().filter(|(of, _)| of.class().is_some());
            assert_eq!(named.count(), 0, "{recordings}: {amplitude}");
        }
    }
}

/// A touch of little more than nine blocks is not waited for longer than it lasts.
#[test]
fn a_touch_that_lasts_a_little_is_named_before_it_ends() {
    let short = |label: &str, amplitude, seed| {
        let mut trial = lasting(label, amplitude, seed);
        trial.samples.truncate(600);
        trial.touches.truncate(600);
        trial
    };
    let known = [("smooth", 20.0), ("rough", 180.0)];
    let trials = (0..12).flat_map(|n| {
        let seeded = known.iter().zip(2 * n..);
        seeded.map(move |((label, amplitude), seed)| short(label, *amplitude, seed))
    });
    let trained = train(&trials.collect::<Vec<_>>(), &Options::default()).unwrap();
    let model = trained.model().unwrap();
    for ((label, amplitude), seed) in known.iter().zip(100..) {
        let class = model.names().position(|name| name == *label);
        let said = decisions(&model, &short(label, *amplitude, seed));
        assert!(said.iter().any(|(of, _)| of.class() == class));
    }
}

/// What would be another class at a scale that is a fifth off is not named as that one.
#[test]
fn a_sensor_that_reads_less_makes_no_other_class_of_one() {
    let known = [("soft", 40.0), ("middling", 64.0), ("rough", 80.0)];
    let trials = (0..12).flat_map(|n| {
        let seeded = known.iter().zip(3 * n..);
        seeded.map(move |((label, amplitude), seed)| lasting(label, *amplitude, seed))
    });
    let trained = train(&trials.collect::<Vec<_>>(), &Options::default()).unwrap();
    let model = trained.model().unwrap();
    let named = |(label, amplitude): (&str, f64)| {
        let class = model.names().position(|name| name == label);
        let said = decisions(&model, &lasting(label, amplitude, 200));
        let named = said.iter().map(|(of, _)| of.class());
        let of = |right: bool| move |of: &Option<usize>| of.is_some() && (*of == class) == right;
        let [right, wrong] = [true, false].map(|right| named.clone().filter(of(right)).count());
        (right, wrong, said.len())
    };
    for (label, amplitude) in known {
        for gain in [0.8, 1.2] {
            let (_, wrong, all) = named((label, gain * amplitude));
            assert!(20 * wrong <= all, "{label} {gain}: {wrong} of {all}");
        }
    }
    let (right, _, all) = named(known[0]);
    assert!(10 * right >= 9 * all, "{right} of {all}");
}
