//! Arguments that are wrong: status 2, a message, and nothing written.

use crate::common::{Place, TEXTURED};

const TRAIN: &str = "train --data r.csv";
/// Trains if it may write.
const SINGLE: &str = "train --tables single --data r.csv";
const CLASSIFY: &str = "classify --model m --data r.csv";

#[test]
fn training_options_out_of_range() {
    let place = Place::usual();
    for (option, values) in [
        ("--bins", "0 4097 100000 -3 many"),
        ("--smooth", "-1 NaN inf 4097 wide"),
        ("--block", "0 10001 70000 4294967296 -2 2.5"),
    ] {
        for value in values.split(' ') {
            for train in [TRAIN, SINGLE] {
                place.refuses_to_write(&format!("{train} {option} {value}"), &[option, value]);
            }
        }
    }
    for (option, values) in [
        ("--gate", "-0.1 1.1 NaN pi"),
        ("--gap", "0 -1 10.1 NaN inf"),
    ] {
        for value in values.split(' ') {
            place.refuses_to_write(&format!("{TRAIN} {option} {value}"), &[option, value]);
            place.write("t.toml", TEXTURED);
            let score = format!("score t.toml --seeds 5..9 {option} {value}");
            place.refuses(&score, &[option, value]);
        }
    }
    for (options, naming) in [
        (format!("{SINGLE} --gap 0.1"), ["--gap", "joint"]),
        (format!("{SINGLE} --plot p.svg"), ["--plot", "evaluate"]),
        (format!("{TRAIN} --plot p.png"), ["--plot", ".svg"]),
        (format!("{TRAIN} --rate 0"), ["--rate", "above 0"]),
        (format!("{TRAIN} --unknown mud"), ["--unknown", "high, low"]),
        (format!("{TRAIN} --bins 1"), ["--bins", "2 to 128"]),
        (format!("{TRAIN} --tables some"), ["joint", "single"]),
        (format!("{TRAIN} --bins="), ["--bins", ""]),
    ] {
        place.refuses_to_write(&options, &naming);
    }
}

#[test]
fn rules_that_no_one_can_follow() {
    let place = Place::usual();
    let refuses = |rule: &str, naming: &[&str]| {
        place.refuses_to_write(&format!("{CLASSIFY} --rule {rule}"), naming);
    };
    refuses("bogus", &["bogus", "sequential", "window"]);
    refuses("sequential", &["--threshold"]);
    refuses("window", &["--window"]);
    refuses("window --threshold 0.9", &["--window"]);
    for threshold in "0 1 1.5 -1 -0.5 nan inf 0.9999999999999 p".split(' ') {
        let rule = format!("sequential --threshold {threshold}");
        refuses(&rule, &["--threshold"]);
    }
    for window in "0 30 19 21 -20 1e3 4294967296".split(' ') {
        refuses(&format!("window --window {window}"), &["--window", window]);
    }
    refuses("window --window 30", &["block of 20"]);
}

#[test]
fn wishes_that_no_threshold_fulfils() {
    let place = Place::usual();
    let evaluate = "evaluate --model m --data r.csv";
    for (option, values) in [
        ("--threshold", "0 1 nan p"),
        ("--error-rate", "0 1.5 -1 nan"),
        ("--time", "0 -1 nan inf"),
        ("--rate", "0 -1 2.5"),
    ] {
        for value in values.split(' ') {
            place.refuses(&format!("{evaluate} {option} {value}"), &[option]);
        }
    }
    place.refuses("evaluate --model none --data r.csv", &["none: "]);
    place.refuses("evaluate --model m --data none", &["none: "]);
    place.refuses("evaluate --model r.csv --data r.csv", &["r.csv: "]);
}

#[test]
fn scores_of_nothing() {
    let place = Place::usual();
    place.write("t.toml", TEXTURED);
    for (line, naming) in [
        ("s.toml --seeds 5..9", &["s.toml: ", "no textures"][..]),
        ("t.toml", &["--seeds"]),
        ("t.toml --seeds 5", &["--seeds", "A..B"]),
        ("t.toml --seeds 9..5", &["--seeds", "A below B"]),
        (
            "t.toml --seeds 1..9",
            &["--train-seed", "found 2", "1 to 8"],
        ),
        ("t.toml --seeds 5..9 --train-seed 8", &["--train-seed"]),
        ("t.toml --seeds 5..9 --threshold 1", &["--threshold"]),
        (
            "t.toml --seeds 5..9 --unknown mud",
            &["--unknown", "smooth, carpet"],
        ),
        (
            "t.toml --seeds 5..9 --unknown carpet",
            &["training: ", "one class"],
        ),
        ("none.toml --seeds 5..9", &["none.toml: "]),
    ] {
        place.refuses(&format!("score {line}"), naming);
    }
}

/// What is in the way of the output is named.
#[test]
fn outputs_that_cannot_be() {
    let place = Place::usual();
    place.write("file", "not a folder");
    place.write("folder/old", "older");
    place.write("taken/trace.csv/old", "older");
    let classify = format!("{CLASSIFY} --rule window --window 20");
    for (command, out, naming) in [
        (SINGLE, "folder", "folder"),
        (SINGLE, "file/m", "file/m"),
        (SINGLE, "file/deep/m", "file/deep/m"),
        (SINGLE, "folder/..", "folder/.."),
        (SINGLE, "/", "/"),
        (&classify, "folder", "folder"),
        (&classify, "file/d.csv", "file/d.csv"),
        ("run s.toml", "file", "file"),
        ("run s.toml", "file/deep", "file/deep"),
        ("run s.toml", "taken", "taken/trace.csv"),
    ] {
        place.refuses(&format!("{command} --out {out}"), &[naming]);
    }
    let long = "n".repeat(300);
    place.refuses(&format!("{SINGLE} --out {long}"), &["nnn"]);
}

/// Where the system does not let files be made the work has failed: status 1.
#[cfg(target_os = "linux")]
#[test]
fn places_that_cannot_be_written_to() {
    let place = Place::usual();
    let ran = place.run(&format!("{SINGLE} --out /proc/none/m"));
    assert_eq!(ran.status, Some(1), "{ran:?}");
    assert!(ran.stderr.contains("/proc/none/m"), "{ran:?}");
}
