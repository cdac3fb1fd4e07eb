//! `whisker calibrate` and `whisker check`, and what a recording keeps of the first.

use crate::common::{Place, scenes, textures};

/// The bench in free air.
fn bench() -> String {
    format!("--sim {}", scenes("bench.toml").display())
}

/// The number of a line `KEY = NUMBER`.
fn number(text: &str, key: &str) -> f64 {
    let line = text.lines().find(|line| line.starts_with(key)).unwrap();
    line.split_once('=').unwrap().1.trim().parse().unwrap()
}

#[test]
fn a_whisker_is_calibrated_and_a_recording_keeps_it() {
    let place = Place::new();
    let ran = place.done(&format!("calibrate {} --out found", bench()));
    assert!(
        ran.stdout.contains("whisker set motor.kp="),
        "{}",
        ran.stdout
    );
    let toml = place.text("found/calibration.toml");
    // As its scene has the motor: 0.05 of friction.
    assert!(
        (number(&toml, "friction_duty") - 0.05).abs() < 0.003,
        "{toml}"
    );
    for picture in ["steps.svg", "steps.csv", "steps.png"] {
        assert!(
            place.path(&format!("found/{picture}")).exists(),
            "{picture}"
        );
    }
    let capture = format!(
        "capture {} --world {} --label smooth --touches 2",
        bench(),
        textures().display()
    );
    place.done(&format!(
        "{capture} --calibration found/calibration.toml --out c.csv"
    ));
    let recording = place.text("c.csv");
    let zero = recording
        .lines()
        .find(|line| line.contains("zero_codes"))
        .unwrap();
    assert!(zero.starts_with("# calibration.zero_codes = ["), "{zero}");
    let said = place.refused(&format!("{capture} --calibration c.csv --out d.csv"));
    assert!(said.contains("c.csv: TOML parse error"), "{said}");
    place.write("other.toml", "a = 1\n");
    let said = place.refused(&format!("{capture} --calibration other.toml --out d.csv"));
    assert!(said.contains("no zero_codes in it"), "{said}");
    assert!(!place.path("d.csv").exists());
}

#[test]
fn what_touches_something_is_to_be_taken_away() {
    let place = Place::new();
    let ran = place.done(&format!(
        "calibrate {} --world {} --out found",
        bench(),
        textures().display()
    ));
    let warning = "x swings too far for free air: take away what the whisker touches";
    assert!(ran.stderr.contains(warning), "{}", ran.stderr);
}

#[test]
fn a_check_of_what_its_scene_says_finds_nothing() {
    let place = Place::new();
    let ran = place.done(&format!("check {} --seconds 12 --out report", bench()));
    assert!(
        ran.stdout.contains("0 of 17 figures need a look"),
        "{}",
        ran.stdout
    );
    let report = place.text("report/check.md");
    assert!(
        report.contains("| records lost |  | 0 | 0 | 0 |"),
        "{report}"
    );
    // In a world in which it meets something the check says what differs.
    let ran = place.run(&format!(
        "check {} --world {} --seconds 12 --out touched",
        bench(),
        textures().display()
    ));
    assert_eq!(ran.status, Some(1), "{}", ran.stdout);
    assert!(ran.stdout.contains("swing of "), "{}", ran.stdout);
}
