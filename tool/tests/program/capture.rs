//! `whisker capture`: what it does with files, labels and touches.

use std::fs;

use host_sim::files::read_recording;
use host_sim::recording::{CHANNELS, GATE, Stream};

use crate::common::{OTHER, Place};

fn recording(place: &Place, name: &str) -> Vec<Stream> {
    read_recording(&place.path(name), CHANNELS).unwrap()
}

fn shape(streams: &[Stream]) -> Vec<(&str, &str, usize)> {
    let of = |stream: &Stream| {
        let touches = stream.touches(GATE, 1);
        let mut touches: Vec<_> = touches.filter(|touch| *touch != 0).collect();
        touches.dedup();
        touches.len()
    };
    let shape = streams.iter().map(|s| (&*s.label, &*s.trial, of(s)));
    shape.collect()
}

#[test]
fn labels_have_as_many_touches_as_were_asked_for() {
    let place = Place::new();
    let ran = place.done(
        "capture --sim bench.toml --label carpet --label floor=smooth --touches 7 --out c.csv",
    );
    let trials = |label| [(label, "0", 5), (label, "1", 2)];
    let expected = ["carpet", "floor"].map(trials).concat();
    assert_eq!(shape(&recording(&place, "c.csv")), expected);
    assert!(place.text("c.csv").starts_with(
        "# board = simulated\n# firmware = 0.1.0\n# scene = bench\n# tick_hz = 2000\n# side = left\nlabel,"
    ));
    assert!(ran.stdout.starts_with("carpet: 7 touches, "), "{ran:?}");
    ran.prints("14 touches; records lost: 0 of ");
    ran.prints("\nfrom the first touch: ");
    ran.prints(" s of the module's time\nnext: ");
    ran.prints("host-sim -- train --data c.csv --rate 2000");
    // What is clean has no warning.
    assert_eq!(ran.stderr, "");
}

#[test]
fn a_file_is_not_overwritten_but_gone_on_with() {
    let place = Place::new();
    let capture = "capture --sim bench.toml --out c.csv --label smooth";
    place.done(&format!("{capture} --touches 6"));
    let before = place.text("c.csv");
    let why = "is not overwritten; name another file, or go on with this one by --resume";
    place.refuses(&format!("{capture} --touches 6"), why);
    assert_eq!(place.text("c.csv"), before);

    // More of one label, and another one.
    place.done(&format!("{capture} --label carpet --touches 8 --resume"));
    let after = place.text("c.csv");
    assert!(after.starts_with(&before), "what was there has changed");
    let streams = recording(&place, "c.csv");
    let smooth = [("smooth", "0", 5), ("smooth", "1", 1), ("smooth", "2", 2)];
    let carpet = [("carpet", "0", 5), ("carpet", "1", 3)];
    assert_eq!(shape(&streams), [&smooth[..], &carpet].concat());
    // Not the same touches again.
    assert_ne!(streams[0].samples[..2000], streams[2].samples[..2000]);

    let ran = place.done(&format!("{capture} --touches 8 --resume"));
    ran.prints("8 touches of each label already");
    assert_eq!(place.text("c.csv"), after);

    // Another module's touches do not belong there.
    place.bench("other.toml", &[OTHER]);
    let other = "capture --sim other.toml --out c.csv --label felt=carpet --resume";
    place.refuses(other, "scene is bench, this one's is other");
    place.write("zero.toml", "zero_codes = [8190, 8200]\n");
    let calibrated = format!("{capture} --label felt=carpet --resume --calibration zero.toml");
    place.refuses(&calibrated, "whose calibration.zero_codes is none");
    let right = format!("{capture} --label felt=carpet --resume --side right");
    place.refuses(&right, "whose side is left, this one's is right");
    assert_eq!(place.text("c.csv"), after);
}

#[test]
fn a_file_has_several_poses() {
    let place = Place::new();
    let capture = "capture --sim bench.toml --out c.csv --label smooth --touches 2";
    let ran = place.done(&format!("{capture} --pose flat --stands -1.5,20"));
    ran.prints("\nnext: another sample, as a model tells samples apart");
    place.done(&format!("{capture} --pose tilted --resume"));
    let streams = recording(&place, "c.csv");
    assert_eq!(shape(&streams), [("smooth", "0", 2), ("smooth", "1", 2)]);
    let poses = streams.iter().map(|of| (of.pose.as_deref(), of.stands));
    let flat = (Some("flat"), Some([-1.5, 20.0]));
    assert!(poses.eq([flat, (Some("tilted"), None)]));
    let other = format!("{capture} --pose other --resume --stands 3");
    place.refuses(&other, "allowed: two numbers with a comma between them");
    let ran = place.done(&format!("{capture} --pose flat --resume"));
    ran.prints("2 touches of each label already");
}

#[test]
fn where_nothing_is_touched_it_says_what_to_look_at() {
    let place = Place::new();
    // Out of reach.
    place.bench("far.toml", &[("[100.0]", "[150.0]")]);
    let ran = place.fails("capture --sim far.toml --out c.csv --label smooth --patience 3");
    ran.warns("smooth: no touch in 3 s; is the sample within reach");
    assert!(!place.path("c.csv").exists());
    assert_eq!(fs::read_dir(place.path(".")).unwrap().count(), 2);
}

#[test]
fn a_sensor_at_its_ends_is_reported_at_once() {
    let place = Place::new();
    place.bench("stiff.toml", &[("ness = 0.1", "ness = 10.0")]);
    let ran = place.done("capture --sim stiff.toml --out c.csv --label smooth --touches 3");
    ran.warns("smooth: x is at the end of its range");
}

#[test]
fn what_is_wrong_is_said_before_anything_is_captured() {
    let place = Place::new();
    let ideal = [
        ("\"textured\"", "\"ideal\""),
        ("textures", "#textures"),
        ("present_s", "#present_s"),
    ];
    place.bench("ideal.toml", &ideal);
    for (options, why) in [
        ("", "--label"),
        ("--label p240", "allowed: smooth, carpet"),
        ("--label carpet --label a=b", "found \"b\""),
        ("--label carpet --label carpet=smooth", "\"carpet\" twice"),
        ("--label unknown=carpet", "a name but \"unknown\""),
        ("--label carpet --touches 0", "--touches"),
    ] {
        let line = format!("capture --sim bench.toml --out c.csv {options}");
        place.refuses(&line, why);
    }
    let ideal = "capture --sim ideal.toml --out c.csv --label smooth";
    place.refuses(ideal, "has no textures");
    place.refuses(
        "calibrate --sim ideal.toml --out c",
        "no motor turns a whisker",
    );
    let motor = "bringup --sim ideal.toml --motor --yes --steps motor";
    place.done(motor).prints("not done: no motor turns");
    assert!(!place.path("c.csv").exists());
}
