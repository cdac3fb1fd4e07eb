//! Arguments that are wrong: status 2, a message, and nothing written.

use crate::common::{IDEAL, Place, RECORDING, model};

fn place() -> Place {
    let place = Place::with(&[("r.csv", RECORDING), ("s.toml", IDEAL)]);
    place.write("m", model(2, 20, true));
    place
}

const TRAIN: [&str; 3] = ["train", "--data", "r.csv"];
const CLASSIFY: [&str; 5] = ["classify", "--model", "m", "--data", "r.csv"];

#[test]
fn commands_and_options_that_are_not_there_or_are_missing() {
    let place = place();
    let cases: [(&[&str], &[&str]); 10] = [
        (&["bogus"], &["bogus"]),
        (&["runn", "s.toml", "--out", "o"], &["runn", "run"]),
        (&["--loud"], &["--loud"]),
        (&["run", "--out", "o"], &["<SCENE>"]),
        (&["run", "s.toml"], &["--out"]),
        (&["run", "s.toml", "s.toml", "--out", "o"], &["s.toml"]),
        (&["train", "--out", "o"], &["--data"]),
        (&["train", "--data", "r.csv"], &["--out"]),
        (
            &["classify", "--out", "o"],
            &["--model", "--data", "--rule"],
        ),
        (&["run", "s.toml", "--out", "o", "--out", "o"], &["--out"]),
    ];
    for (arguments, naming) in cases {
        place.refuses(arguments, naming);
    }
}

#[test]
fn training_options_out_of_range() {
    let place = place();
    for (option, values) in [
        ("--bins", &["0", "4097", "100000", "-3", "many", ""][..]),
        ("--smooth", &["-1", "NaN", "inf", "4097", "wide"]),
        (
            "--block",
            &["0", "10001", "70000", "4294967296", "-2", "2.5"],
        ),
    ] {
        for value in values {
            place.refuses_to_write(&[&TRAIN[..], &[option, value]].concat(), &[option, value]);
        }
    }
}

#[test]
fn rules_that_no_one_can_follow() {
    let place = place();
    let refuses = |rule: &[&str], naming: &[&str]| {
        place.refuses_to_write(&[&CLASSIFY[..], &["--rule"], rule].concat(), naming);
    };
    refuses(&["bogus"], &["bogus", "sequential", "window"]);
    refuses(&["sequential"], &["--threshold"]);
    refuses(&["window"], &["--window"]);
    refuses(&["window", "--threshold", "0.9"], &["--window"]);
    for threshold in [
        "0",
        "1",
        "1.5",
        "-1",
        "-0.5",
        "nan",
        "inf",
        "0.9999999999999",
        "p",
    ] {
        refuses(&["sequential", "--threshold", threshold], &["--threshold"]);
    }
    for window in ["0", "30", "19", "21", "-20", "1e3", "4294967296"] {
        refuses(&["window", "--window", window], &["--window", window]);
    }
    refuses(&["window", "--window", "30"], &["block of 20"]);
}

/// What is in the way of the output is named.
#[test]
fn outputs_that_cannot_be() {
    let place = place();
    place.write("file", "not a folder");
    place.write("folder/old", "older");
    place.write("taken/trace.csv/old", "older");
    let classify = [&CLASSIFY[..], &["--rule", "window", "--window", "20"]].concat();
    for (command, out, naming) in [
        (&TRAIN[..], "folder", "folder"),
        (&TRAIN, "file/m", "file/m"),
        (&TRAIN, "file/deep/m", "file/deep/m"),
        (&TRAIN, "folder/..", "folder/.."),
        (&TRAIN, "/", "/"),
        (&classify, "folder", "folder"),
        (&classify, "file/d.csv", "file/d.csv"),
        (&["run", "s.toml"], "file", "file"),
        (&["run", "s.toml"], "file/deep", "file/deep"),
        (&["run", "s.toml"], "taken", "taken/trace.csv"),
    ] {
        place.refuses(&[command, &["--out", out]].concat(), &[naming]);
    }
    let long = "n".repeat(300);
    place.refuses(&[&TRAIN[..], &["--out", &long]].concat(), &["nnn"]);
}

/// Where the system does not let files be made the work has failed: status 1.
#[cfg(target_os = "linux")]
#[test]
fn places_that_cannot_be_written_to() {
    let place = place();
    let ran = place.run(&[&TRAIN[..], &["--out", "/proc/none/m"]].concat());
    assert_eq!(ran.status, Some(1), "{ran:?}");
    assert!(ran.stderr.contains("/proc/none/m"), "{ran:?}");
}
