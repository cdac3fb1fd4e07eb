//! The joint trainer on problems whose answer is known.

use crate::common::{normal, threshold};
use tactile::train::Expect;
use tactile::train::TrainError;
use tactile::train::joint::{Options, Trial, Warning, train};
use tactile::{Sequential, TableSource};

/// A trial of normal x and y of sd 100, independent from sample to sample, about a mean.
fn trial(label: &str, recording: &str, mean: [f64; 2], length: usize, seed: u64) -> Trial {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let samples = (0..length).map(|_| mean.map(|m| (m + 100.0 * normal(&mut state)).round()));
    Trial {
        label: label.to_owned(),
        recording: recording.to_owned(),
        samples: samples.collect(),
        touches: vec![1; length],
        ..Trial::default()
    }
}

/// Tables and floors alone: these classes differ by their means, of which an opinion that
/// expects another pose makes nothing.
fn same() -> Options {
    Options {
        expect: Expect::Same,
        ..Options::default()
    }
}

/// Trials of two classes by turns, whose means are `apart` standard deviations apart.
fn of_two(count: usize, apart: f64, length: usize) -> Vec<Trial> {
    let means = [[-50.0 * apart, 0.0], [50.0 * apart, 0.0]];
    let all = (0..count).zip(1..);
    all.map(|(n, seed)| trial(["a", "b"][n % 2], "one", means[n % 2], length, seed))
        .collect()
}

#[test]
fn two_normals_have_their_likelihood_ratio_and_posterior() {
    // Blocks of one sample: each is a step of evidence of its own, as in theory.
    let options = Options {
        bins: 32,
        block: 1,
        expect: Expect::Same,
        ..Options::default()
    };
    // So many trials that their weights are their own.
    let trained = train(&of_two(200, 0.5, 400), &options).unwrap();
    assert_eq!(trained.names, ["a", "b"]);
    let table = &trained.tables[0];
    assert_eq!(table.source, TableSource::Samples);
    // ln p(b)/p(a) of code x is x · 50/100² here.
    let range = table.axes[0];
    let width = f64::from(range.high - range.low) / 32.0;
    for bin in 6..26 {
        let x = f64::from(range.low) + (bin as f64 + 0.5) * width;
        let exact = x * 50.0 / 1e4 / std::f64::consts::LN_2;
        let cell = 2 * (bin * 32 + 16);
        let found = table.log2_p[cell + 1] - table.log2_p[cell];
        assert!((found - exact).abs() < 0.35, "{x}: {found} {exact}");
    }
    // Samples are independent, and roughness adds nothing to them. The sum of the weights is
    // drawn from one to the 1.2 of textures.
    let [samples, roughness] = trained.weights[..] else {
        panic!("{:?}", trained.weights);
    };
    assert!((0.85..=1.05).contains(&samples), "{samples}");
    assert!(roughness < 0.2, "{roughness}");
    for at in &trained.report.calibration {
        let (found, stated) = (at.found, at.stated);
        assert!(found.count > 500, "{at:?}");
        assert!((found.share - stated).abs() < 0.015, "{at:?}");
    }
    // Wald's mean number of samples to a posterior of 99 % from ratios of 1/8 nat each:
    // (0.98 ln 99)/0.125, and less than two more of overshoot.
    let at = trained.report.calibration[4];
    assert_eq!(at.threshold, 0.99);
    assert!((34.0..=46.0).contains(&at.samples), "{at:?}");
}

#[test]
fn warnings_say_what_the_trials_cannot_tell() {
    // Two classes from the same source, one far away in a single trial.
    let mut trials = of_two(10, 0.0, 2_000);
    trials.push(trial("c", "one", [0.0, 2_000.0], 2_000, 99));
    let trained = train(&trials, &same()).unwrap();
    let warnings = &trained.report.warnings;
    let c = || "c".to_owned();
    let few = Warning::FewTrials {
        name: c(),
        trials: 1,
    };
    assert!(warnings.contains(&Warning::Halved { name: c() }) && warnings.contains(&few));
    assert!(warnings.contains(&Warning::OneRecording));
    let alike = warnings.iter().filter_map(|warning| match warning {
        Warning::Alike { names, .. } => Some(names.clone()),
        _ => None,
    });
    let alike: Vec<_> = alike.collect();
    assert_eq!(alike, [["a".to_owned(), "b".to_owned()]]);
    // Tables that decide alone say the same of both.
    let rows = trained
        .tables
        .iter()
        .flat_map(|table| table.log2_p.chunks(3));
    assert!(rows.clone().all(|row| row[0] == row[1]) && rows.clone().any(|row| row[1] != row[2]));

    let mut trials = of_two(10, 2.0, 2_000);
    for (n, trial) in trials.iter_mut().enumerate() {
        trial.recording = (n / 4).to_string();
    }
    let warnings = train(&trials, &same()).unwrap().report.warnings;
    assert!(!warnings.contains(&Warning::OneRecording));
    assert!(!warnings.contains(&Warning::NotAcrossRecordings));
}

#[test]
fn faults_are_named() {
    let refused = |change: fn(&mut Vec<Trial>), error| {
        let mut trials = of_two(10, 1.0, 100);
        change(&mut trials);
        assert_eq!(train(&trials, &same()).unwrap_err(), error);
    };
    let name = "b".to_owned();
    refused(Vec::clear, TrainError::NoSamples);
    refused(|trials| trials.truncate(1), TrainError::OneClass);
    refused(
        |trials| {
            let of_b = trials.iter_mut().skip(1).step_by(2);
            of_b.for_each(|trial| trial.touches.fill(0));
        },
        TrainError::TooShort { name },
    );
    refused(
        |trials| trials[3].samples[5][1] = f64::NAN,
        TrainError::NotFinite { channel: 1 },
    );
    refused(|trials| trials[3].label.clear(), TrainError::NameEmpty);
    let options = Options {
        bins: 1,
        expect: Expect::Same,
        ..Options::default()
    };
    let error = train(&of_two(10, 1.0, 100), &options).unwrap_err();
    assert_eq!(error.to_string(), "bins 1; 2 to 128 is allowed");
}

#[test]
fn the_model_file_decides_as_the_report_says() {
    // Blocks of 20 independent samples deserve far more weight than one recording's ten
    // trials can justify, so that decisions are slow and all right.
    let options = Options {
        block: 20,
        expect: Expect::Same,
        ..Options::default()
    };
    let trained = train(&of_two(10, 0.5, 20_000), &options).unwrap();
    let model = trained.model().unwrap();
    let rule = model.touch_rule().unwrap();
    assert_eq!((rule.limit, rule.gap), (2048, 200));
    let mut classifier = Sequential::new(model, threshold(0.99)).unwrap();
    let (mut decided, mut right, mut samples) = (0, 0, 0.0);
    for (n, fresh) in of_two(10, 0.5, 20_000).iter().enumerate() {
        // The same means, other samples.
        let mean = [if n % 2 == 0 { -25.0 } else { 25.0 }, 0.0];
        let other = trial(&fresh.label, "two", mean, 20_000, n as u64 + 100);
        classifier.touch(n as u16);
        for sample in &other.samples {
            let codes = [0, 1].map(|k| trained.scales[k].code_from_f64(sample[k]));
            if let Some(decision) = classifier.push(&codes).unwrap() {
                decided += 1;
                right += usize::from(decision.leader() == n % 2);
                samples += f64::from(decision.samples());
            }
        }
    }
    let at = trained.report.calibration[4];
    let are_right = right as f64 > 0.98 * f64::from(decided);
    assert!(are_right && decided > 200, "{right} of {decided}");
    let share = samples / f64::from(decided) / at.samples;
    assert!((share - 1.0).abs() < 0.15, "{share} {at:?}");
}
