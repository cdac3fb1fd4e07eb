//! `whisker calibrate` and `whisker check`, and what a recording keeps of the first.

use crate::common::Place;

fn number(text: &str, key: &str) -> f64 {
    let line = text.lines().find(|line| line.starts_with(key)).unwrap();
    line.split_once('=').unwrap().1.trim().parse().unwrap()
}

#[test]
fn a_whisker_is_calibrated_and_a_recording_keeps_it() {
    let place = Place::new();
    let ran = place.done("calibrate --sim @bench.toml --out found");
    ran.prints("whisker set motor.kp=");
    let toml = place.text("found/calibration.toml");
    // As its scene has the motor: 0.05 of friction.
    let friction = number(&toml, "friction_duty");
    assert!((friction - 0.05).abs() < 0.003, "{toml}");
    for file in ["steps.svg", "steps.csv", "steps.png"] {
        assert!(place.path("found").join(file).exists(), "{file}");
    }
    let capture = "capture --sim @bench.toml --world @textures.toml --label smooth --touches 2";
    place.done(&format!(
        "{capture} --calibration found/calibration.toml --out c.csv"
    ));
    place.holds("c.csv", "\n# calibration.zero_codes = [");
    place.write("other.toml", "a = 1\n");
    for (file, why) in [
        ("c.csv", "c.csv: TOML parse error"),
        ("other.toml", "no zero_codes in it"),
    ] {
        place.refuses(&format!("{capture} --calibration {file} --out d.csv"), why);
    }
    assert!(!place.path("d.csv").exists());
}

#[test]
fn what_touches_something_is_to_be_taken_away() {
    let ran = Place::new().done("calibrate --sim @bench.toml --world @textures.toml --out found");
    ran.warns("x swings too far for free air: take away what the whisker touches");
}

#[test]
fn a_check_of_what_its_scene_says_finds_nothing() {
    let place = Place::new();
    let check = "check --sim @bench.toml --seconds 12 --out report";
    place.done(check).prints("0 of 17 figures need a look");
    place.holds("report/check.md", "| records lost |  | 0 | 0 | 0 |");
    // A whisker without a motor is watched as well.
    let passive = "check --sim @passive.toml --seconds 8 --out passive";
    place.done(passive).prints("0 of ");
    // In a world in which it meets something it says what differs.
    let ran = place.fails(&format!("{check} --world @textures.toml"));
    ran.prints("swing of ");
}
