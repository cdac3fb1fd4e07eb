//! Arguments that are wrong: status 2, a message, and nothing written.

use crate::common::Place;

const TRAIN: &str = "train --data r.csv";
/// Trains if it may write.
const SINGLE: &str = "train --tables single --data r.csv";
const CLASSIFY: &str = "classify --model m --data r.csv";
const EVALUATE: &str = "evaluate --model m --data r.csv";

#[test]
fn values_out_of_range() {
    let place = Place::usual();
    let score = "score t.toml --seeds 5..9";
    let sequential = &format!("{CLASSIFY} --rule sequential");
    let window = &format!("{CLASSIFY} --rule window");
    let (trains, decides) = (&[TRAIN, SINGLE][..], &[sequential, EVALUATE][..]);
    for (commands, option, values) in [
        (trains, "--bins", "0 4097 100000 -3 many"),
        (trains, "--smooth", "-1 NaN inf 4097 wide"),
        (trains, "--block", "0 10001 70000 4294967296 -2 2.5"),
        (&[TRAIN, score], "--gate", "-0.1 1.1 NaN pi"),
        (&[TRAIN, score], "--gap", "0 -1 10.1 NaN inf"),
        (decides, "--threshold", "0 1 1.5 -1 NaN inf p"),
        (&[sequential], "--threshold", "0.9999999999999"),
        (&[window], "--window", "0 30 19 21 -20 1e3 4294967296"),
        (&[EVALUATE], "--error-rate", "0 1.5 -1 NaN"),
        (&[EVALUATE], "--time", "0 -1 NaN inf"),
        (&[EVALUATE], "--rate", "0 -1 2.5"),
    ] {
        for value in values.split(' ') {
            for command in commands {
                place.refuses_each(&format!("{command} {option} {value} | {option} | {value}"));
            }
        }
    }
}

#[test]
fn what_no_one_can_do() {
    Place::usual().refuses_each(
        "train --tables single --data r.csv --gap 0.1 | --gap | joint
         train --tables single --data r.csv --plot p.svg | --plot | evaluate
         train --data r.csv --plot p.png | --plot | .svg
         train --data r.csv --rate 0 | --rate | above 0
         train --data r.csv --unknown mud | --unknown | high, low
         train --data r.csv --bins 1 | --bins | 2 to 128
         train --data r.csv --tables some | joint | single
         train --data r.csv --bins= | --bins
         classify --model m --data r.csv --rule no | sequential | window
         classify --model m --data r.csv --rule sequential | --threshold
         classify --model m --data r.csv --rule window | --window
         classify --model m --data r.csv --rule window --threshold 0.9 | --window
         classify --model m --data r.csv --rule window --window 30 | 30 | block of 20
         evaluate --model none --data r.csv | none:
         evaluate --model m --data none | none:
         evaluate --model r.csv --data r.csv | r.csv:
         score s.toml --seeds 5..9 | s.toml: | no textures
         score t.toml | --seeds
         score t.toml --seeds 5 | --seeds | A..B
         score t.toml --seeds a..9 | --seeds | A..B
         score t.toml --seeds 9..9 | --seeds | A below B
         score t.toml --seeds 1..9 | --train-seed | found 2 | 1 to 8
         score t.toml --seeds 5..9 --train-seed 8 | --train-seed
         score t.toml --seeds 5..9 --threshold 1 | --threshold
         score t.toml --seeds 5..9 --unknown mud | --unknown | smooth, carpet
         score t.toml --seeds 5..9 --unknown carpet | training: | one class
         score none.toml --seeds 5..9 | none.toml:",
    );
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
