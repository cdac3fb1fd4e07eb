//! `whisker capture`: what it does with files, labels and touches.

use std::fs;

use host_sim::files::read_recording;
use host_sim::recording::{CHANNELS, GATE, Stream};

use crate::common::{BENCH, Place};

fn recording(place: &Place, name: &str) -> Vec<Stream> {
    read_recording(&place.path(name), CHANNELS).unwrap()
}

/// Label, trial and touches of each stream.
fn shape(streams: &[Stream]) -> Vec<(&str, &str, usize)> {
    let of = |stream: &Stream| {
        let mut touches: Vec<_> = stream
            .touches(GATE, 1)
            .filter(|touch| *touch != 0)
            .collect();
        touches.dedup();
        touches.len()
    };
    let shape = streams
        .iter()
        .map(|s| (s.label.as_str(), s.trial.as_str(), of(s)));
    shape.collect()
}

#[test]
fn labels_have_as_many_touches_as_were_asked_for() {
    let place = Place::new();
    let ran = place.done(
        "capture --sim bench.toml --label carpet --label floor=smooth --touches 7 --out c.csv",
    );
    assert_eq!(
        shape(&recording(&place, "c.csv")),
        [
            ("carpet", "0", 5),
            ("carpet", "1", 2),
            ("floor", "0", 5),
            ("floor", "1", 2)
        ]
    );
    assert!(place.text("c.csv").starts_with(
        "# board = simulated\n# firmware = 0.1.0\n# scene = bench\n# tick_hz = 2000\nlabel,"
    ));
    let lines: Vec<&str> = ran.stdout.lines().collect();
    assert!(lines[0].starts_with("carpet: 7 touches, "), "{lines:?}");
    assert!(
        lines[2].contains("14 touches; records lost: 0 of "),
        "{lines:?}"
    );
    assert!(
        lines[3].starts_with("from the first touch: ")
            && lines[3].ends_with(" s of the module's time"),
        "{lines:?}"
    );
    assert!(
        lines[4].contains("host-sim -- train --data c.csv --rate 2000"),
        "{lines:?}"
    );
    // A clean recording has no warnings.
    assert_eq!(ran.stderr, "");
}

#[test]
fn a_file_is_not_overwritten_but_gone_on_with() {
    let place = Place::new();
    let capture = "capture --sim bench.toml --out c.csv --label smooth";
    place.done(&format!("{capture} --touches 6"));
    let before = place.text("c.csv");
    let said = place.refused(&format!("{capture} --touches 6"));
    assert!(
        said.contains("not overwritten") && said.contains("--resume"),
        "{said}"
    );
    assert_eq!(place.text("c.csv"), before);

    // More of one label, and another one.
    place.done(&format!("{capture} --label carpet --touches 8 --resume"));
    let after = place.text("c.csv");
    assert!(after.starts_with(&before), "what was there has changed");
    assert_eq!(
        shape(&recording(&place, "c.csv")),
        [
            ("smooth", "0", 5),
            ("smooth", "1", 1),
            ("smooth", "2", 2),
            ("carpet", "0", 5),
            ("carpet", "1", 3)
        ]
    );
    // Not the same touches again.
    let streams = recording(&place, "c.csv");
    assert_ne!(streams[0].samples[..2000], streams[2].samples[..2000]);

    let ran = place.done(&format!("{capture} --touches 8 --resume"));
    assert!(
        ran.stdout.contains("8 touches of each label already"),
        "{}",
        ran.stdout
    );
    assert_eq!(place.text("c.csv"), after);

    // Another module's touches do not belong there.
    place.write("other.toml", &BENCH.replace("\"bench\"", "\"other\""));
    let said = place.refused("capture --sim other.toml --out c.csv --label felt=carpet --resume");
    assert!(
        said.contains("scene is bench, this one's is other"),
        "{said}"
    );
    assert_eq!(place.text("c.csv"), after);
}

#[test]
fn where_nothing_is_touched_it_says_what_to_look_at() {
    let place = Place::new();
    // Out of reach.
    place.write("far.toml", &BENCH.replace("[100.0]", "[150.0]"));
    let ran = place.run("capture --sim far.toml --out c.csv --label smooth --patience 3");
    assert_eq!(ran.status, Some(1));
    assert!(
        ran.stderr
            .contains("smooth: no touch in 3 s; is the sample within reach"),
        "{}",
        ran.stderr
    );
    assert!(!place.path("c.csv").exists());
    assert_eq!(fs::read_dir(place.path(".")).unwrap().count(), 2);
}

#[test]
fn a_sensor_at_its_ends_is_reported_at_once() {
    let place = Place::new();
    place.write(
        "stiff.toml",
        &BENCH.replace("stiffness = 0.1", "stiffness = 10.0"),
    );
    let ran = place.done("capture --sim stiff.toml --out c.csv --label smooth --touches 3");
    assert!(
        ran.stderr.contains("smooth: x is at the end of its range"),
        "{}",
        ran.stderr
    );
}

#[test]
fn what_is_wrong_is_said_before_anything_is_captured() {
    let place = Place::new();
    let said = |more: &str| place.refused(&format!("capture --sim bench.toml --out c.csv {more}"));
    assert!(said("").contains("--label"));
    assert!(said("--label p240").contains("allowed: smooth, carpet"));
    assert!(said("--label carpet --label a=b").contains("found \"b\""));
    assert!(said("--label carpet --label carpet=smooth").contains("\"carpet\" twice"));
    assert!(said("--label unknown=carpet").contains("a name but \"unknown\""));
    assert!(said("--label carpet --touches 0").contains("--touches"));
    let ideal = BENCH
        .replace("\"textured\"", "\"ideal\"")
        .replace("textures", "#textures");
    place.write("ideal.toml", &ideal.replace("present_s", "#present_s"));
    let said = place.refused("capture --sim ideal.toml --out c.csv --label smooth");
    assert!(said.contains("has no textures"), "{said}");
    assert!(!place.path("c.csv").exists());
}
