//! Arguments that are wrong: status 2, a message, and nothing written.

use crate::common::{Place, TEXTURED};

const TRAIN: &str = "train --data r.csv";
/// Trains if it may write.
const SINGLE: &str = "train --tables single --data r.csv";
const CLASSIFY: &str = "classify --model m --data r.csv";
const EVALUATE: &str = "evaluate --model m --data r.csv";

/// Without output there is nothing to overwrite.
fn refuses(place: &Place, line: &str, naming: &[&str]) {
    if line.starts_with("train") || line.starts_with("classify") {
        place.refuses_to_write(line, naming);
    } else {
        place.refuses(line, naming);
    }
}

#[test]
fn values_out_of_range() {
    let place = Place::usual();
    place.write("t.toml", TEXTURED);
    let score = "score t.toml --seeds 5..9";
    let sequential = &format!("{CLASSIFY} --rule sequential");
    let window = &format!("{CLASSIFY} --rule window");
    for (commands, option, values) in [
        (&[TRAIN, SINGLE][..], "--bins", "0 4097 100000 -3 many"),
        (&[TRAIN, SINGLE], "--smooth", "-1 NaN inf 4097 wide"),
        (
            &[TRAIN, SINGLE],
            "--block",
            "0 10001 70000 4294967296 -2 2.5",
        ),
        (&[TRAIN, score], "--gate", "-0.1 1.1 NaN pi"),
        (&[TRAIN, score], "--gap", "0 -1 10.1 NaN inf"),
        (
            &[sequential, EVALUATE],
            "--threshold",
            "0 1 1.5 -1 NaN inf p",
        ),
        (&[sequential], "--threshold", "0.9999999999999"),
        (&[window], "--window", "0 30 19 21 -20 1e3 4294967296"),
        (&[EVALUATE], "--error-rate", "0 1.5 -1 NaN"),
        (&[EVALUATE], "--time", "0 -1 NaN inf"),
        (&[EVALUATE], "--rate", "0 -1 2.5"),
    ] {
        for value in values.split(' ') {
            for command in commands {
                let line = format!("{command} {option} {value}");
                refuses(&place, &line, &[option, value]);
            }
        }
    }
}

#[test]
fn what_no_one_can_do() {
    let place = Place::usual();
    place.write("t.toml", TEXTURED);
    for (line, naming) in [
        (format!("{SINGLE} --gap 0.1"), &["--gap", "joint"][..]),
        (format!("{SINGLE} --plot p.svg"), &["--plot", "evaluate"]),
        (format!("{TRAIN} --plot p.png"), &["--plot", ".svg"]),
        (format!("{TRAIN} --rate 0"), &["--rate", "above 0"]),
        (
            format!("{TRAIN} --unknown mud"),
            &["--unknown", "high, low"],
        ),
        (format!("{TRAIN} --bins 1"), &["--bins", "2 to 128"]),
        (format!("{TRAIN} --tables some"), &["joint", "single"]),
        (format!("{TRAIN} --bins="), &["--bins"]),
        (format!("{CLASSIFY} --rule no"), &["sequential", "window"]),
        (format!("{CLASSIFY} --rule sequential"), &["--threshold"]),
        (format!("{CLASSIFY} --rule window"), &["--window"]),
        (
            format!("{CLASSIFY} --rule window --threshold 0.9"),
            &["--window"],
        ),
        (
            format!("{CLASSIFY} --rule window --window 30"),
            &["30", "block of 20"],
        ),
        ("evaluate --model none --data r.csv".into(), &["none: "]),
        ("evaluate --model m --data none".into(), &["none: "]),
        ("evaluate --model r.csv --data r.csv".into(), &["r.csv: "]),
    ] {
        refuses(&place, &line, naming);
    }
    for (line, naming) in [
        ("s.toml --seeds 5..9", &["s.toml: ", "no textures"][..]),
        ("t.toml", &["--seeds"]),
        ("t.toml --seeds 5", &["--seeds", "A..B"]),
        ("t.toml --seeds a..9", &["--seeds", "A..B"]),
        ("t.toml --seeds 9..9", &["--seeds", "A below B"]),
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
        refuses(&place, &format!("score {line}"), naming);
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
