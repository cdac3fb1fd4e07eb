//! What training and classifying mean, on recordings so small that the
//! posterior has a closed form. The floor of a likelihood is 1e-6.

use host_sim::decisions::Decided;

use crate::common::{Place, decisions};

/// Trains on `training` and classifies `test` with the options of each command.
fn decide(training: &str, options: &str, test: &str, deciding: &str) -> Vec<Decided> {
    let header = "label,trial,x,y\n";
    let place = Place::with(&[
        ("training.csv", &format!("{header}{training}")),
        ("test.csv", &format!("{header}{test}")),
    ]);
    let train = format!("train --tables single --data training.csv --out m {options}");
    place.done(&train);
    let classify = format!("classify --model m --data test.csv --out d.csv {deciding}");
    place.done(&classify);
    decisions(&place.text("d.csv"))
}

/// Class `b` comes first and is high in x, `a` is low; y tells nothing.
const APART: &str = "b,0,100,0\nb,0,100,100\na,0,0,0\na,0,0,100\n";
/// Two bins, not smoothed: a sample in the other class's bin has the floor.
const SHARP: &str = "--bins 2 --smooth 0";

/// `count` samples of one stream.
fn stream(label: &str, trial: u32, x: &[i32]) -> String {
    let row = |x| format!("{label},{trial},{x},50\n");
    x.iter().map(row).collect()
}

fn outcome(decided: &[Decided]) -> Vec<(&str, u32)> {
    decided
        .iter()
        .map(|d| (d.decision.as_str(), d.samples))
        .collect()
}

#[track_caller]
fn near(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found}, not {expected}"
    );
}

#[test]
fn classes_that_never_overlap_are_distinguished_in_one_block() {
    let test = stream("a", 7, &[0; 6]) + &stream("b", 7, &[100; 4]);
    let decided = decide(
        APART,
        &format!("{SHARP} --block 2"),
        &test,
        "--rule sequential --threshold 0.99",
    );
    let expected = [("a", 2), ("a", 2), ("a", 2), ("b", 2), ("b", 2)];
    assert_eq!(outcome(&decided), expected);
    for d in decided {
        assert_eq!((d.label, d.trial.as_str()), (d.decision, "7"));
        // Odds of (1 + 1e-6)/1e-6.
        near(d.posterior, 1.0 - 1e-6, 3e-9);
    }
}

#[test]
fn a_tie_goes_to_the_class_that_the_training_file_has_first() {
    let test = stream("a", 0, &[0, 100]);
    let options = format!("{SHARP} --block 2");
    let decided = decide(APART, &options, &test, "--rule window --window 2");
    assert_eq!(outcome(&decided), [("b", 2)]);
    assert_eq!(decided[0].posterior, 0.5);
    // Names do not matter, the order does.
    let reversed = APART.lines().rev().collect::<Vec<_>>().join("\n");
    let decided = decide(&reversed, &options, &test, "--rule window --window 2");
    assert_eq!(outcome(&decided), [("a", 2)]);
}

/// One sample for `a` and three for `b`: log odds of (3 − 1)/4 · ln 1e6, so
/// odds of 1000 whatever the block.
#[test]
fn a_block_counts_as_the_mean_of_its_samples() {
    for (block, x) in [
        (4, vec![100, 0, 100, 100]),
        (8, vec![100, 0, 100, 100, 0, 100, 100, 100]),
    ] {
        let options = format!("{SHARP} --block {block}");
        let deciding = "--rule sequential --threshold 0.9";
        let decided = decide(APART, &options, &stream("b", 0, &x), deciding);
        assert_eq!(outcome(&decided), [("b", block)]);
        near(decided[0].posterior, 1000.0 / 1001.0, 2e-6);
    }
}

/// Two such blocks multiply their odds.
#[test]
fn evidence_adds_up_over_blocks_and_starts_again_after_a_decision() {
    let x = [100, 0, 100, 100].repeat(5);
    let options = format!("{SHARP} --block 4");
    let deciding = "--rule sequential --threshold 0.9999";
    let decided = decide(APART, &options, &stream("b", 0, &x), deciding);
    assert_eq!(outcome(&decided), [("b", 8), ("b", 8)]);
    near(decided[0].posterior, 1.0 - 1e-6, 3e-9);
    assert_eq!(decided[0].posterior, decided[1].posterior);
}

#[test]
fn evidence_is_dropped_at_the_end_of_a_stream() {
    let x = [100, 0, 100, 100];
    let options = format!("{SHARP} --block 4");
    for deciding in [
        "--rule sequential --threshold 0.9999",
        "--rule window --window 8",
    ] {
        let apart = stream("b", 0, &x) + &stream("b", 1, &x) + &stream("a", 1, &x);
        assert_eq!(decide(APART, &options, &apart, deciding), []);
        let joined = stream("b", 0, &x) + &stream("b", 0, &x);
        let decided = decide(APART, &options, &joined, deciding);
        assert_eq!(outcome(&decided), [("b", 8)], "{deciding}");
    }
    // So is half a block.
    let halves = stream("b", 0, &x[..3]) + &stream("b", 1, &x[..3]);
    let deciding = "--rule window --window 4";
    assert_eq!(decide(APART, &options, &halves, deciding), []);
}

#[test]
fn the_posterior_must_exceed_the_threshold() {
    let tie = stream("b", 0, &[0, 100]);
    let options = format!("{SHARP} --block 2");
    let at = |threshold| format!("--rule sequential --threshold {threshold}");
    assert_eq!(decide(APART, &options, &tie, &at("0.5")), []);
    let decided = decide(APART, &options, &tie, &at("0.49999"));
    assert_eq!(outcome(&decided), [("b", 2)]);
}

#[test]
fn edges_belong_to_the_bins_inside_and_the_middle_to_the_upper_bin() {
    let options = format!("{SHARP} --block 1");
    let x = [-1_000_000, 0, 49, 50, 100, 1_000_000];
    let test = stream("a", 0, &x);
    let decided = decide(APART, &options, &test, "--rule window --window 1");
    let found: String = decided.iter().map(|d| d.decision.as_str()).collect();
    assert_eq!(found, "aaabbb");
}

/// All of `a` in bin 0 and all of `b` in bin 2 of three, smoothed by a Gaussian
/// of one bin: in bin 0 the odds are 1 : e^(−2²/2); with a fifth of a bin it
/// is cut before it reaches the next one.
#[test]
fn smoothing_is_a_gaussian_of_so_many_bins() {
    let decided = |smooth: &str| {
        let options = format!("--bins 3 --block 1 --smooth {smooth}");
        let test = stream("a", 0, &[0]);
        let decided = decide(APART, &options, &test, "--rule window --window 1");
        decided[0].posterior
    };
    near(decided("1"), 1.0 / (1.0 + (-2.0_f64).exp()), 2e-4);
    near(decided("2"), 1.0 / (1.0 + (-0.5_f64).exp()), 2e-4);
    near(decided("0.2"), 1.0 - 1e-6, 3e-9);
}

/// x and y are independent: their odds multiply.
#[test]
fn both_channels_count() {
    let training = "b,0,100,100\na,0,0,0\n";
    let options = "--bins 3 --smooth 1 --block 1";
    let deciding = "--rule window --window 1";
    let posterior = |test| decide(training, options, test, deciding)[0].posterior;
    near(posterior("a,0,0,0\n"), 1.0 / (1.0 + (-4.0_f64).exp()), 2e-4);
    near(
        posterior("a,0,0,50\n"),
        1.0 / (1.0 + (-2.0_f64).exp()),
        2e-4,
    );
    near(
        posterior("a,0,50,0\n"),
        1.0 / (1.0 + (-2.0_f64).exp()),
        2e-4,
    );
    near(posterior("a,0,0,100\n"), 0.5, 1e-12);
}

/// Real numbers of any unit mean the same as whole ones.
#[test]
fn units_do_not_matter() {
    let scaled = |rows: &str, factor: f64, origin: f64| -> String {
        let row = |row: &str| {
            let cells: Vec<&str> = row.split(',').collect();
            let value = |cell: &str| cell.parse::<f64>().unwrap() * factor + origin;
            let (x, y) = (value(cells[2]), value(cells[3]));
            format!("{},{},{x:e},{y:e}\n", cells[0], cells[1])
        };
        rows.lines().map(row).collect()
    };
    let training = "b,0,100,0\nb,0,61,100\na,0,0,0\na,0,39,100\n";
    let test = stream("a", 0, &[0, 13, 42, 49, 51, 99]) + &stream("b", 0, &[83, 27, 33]);
    let options = ("--bins 10 --smooth 2 --block 1", "--rule window --window 3");
    let whole = decide(training, options.0, &test, options.1);
    assert_eq!(whole.len(), 3);
    for (factor, origin) in [(1e-9, 0.0), (0.37, -12.5), (1e200, 3e201)] {
        let training = scaled(training, factor, origin);
        let found = decide(
            &training,
            options.0,
            &scaled(&test, factor, origin),
            options.1,
        );
        assert_eq!(found, whole, "{factor}, {origin}");
    }
}
