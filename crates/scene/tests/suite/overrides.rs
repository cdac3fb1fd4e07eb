//! Keys that are given beside the file.

use crate::common::FULL;
use scene::{Override, Places, Problems, Scene};

fn read(overrides: &[&str]) -> Result<(Scene, Places), Problems> {
    let overrides = overrides.iter().map(|text| text.parse());
    let overrides: Result<Vec<Override>, String> = overrides.collect();
    Scene::from_str_with("s.toml", FULL, &overrides.expect("KEY=VALUE"))
}

#[track_caller]
fn complaint(overrides: &[&str]) -> String {
    read(overrides).expect_err("refused").to_string()
}

#[test]
fn the_scene_is_as_if_the_key_stood_in_the_file() {
    let (plain, _) = read(&[]).expect("a scene");
    let (other, _) = read(&["seed=99", "rcp.gain=0.25", "whisking.noise = 0.5"]).expect("a scene");
    let mut expected = plain.clone();
    expected.seed = 99;
    expected.rcp.as_mut().expect("[rcp]").gain = 0.25;
    expected.whisking.as_mut().expect("[whisking]").noise = 0.5;
    assert_eq!(other, expected);
    // The last one counts; a word needs no quotes, and may have them.
    let (other, _) = read(&["seed=5", "seed=6", "name=other"]).expect("a scene");
    assert_eq!((other.seed, other.name.as_str()), (6, "other"));
    let (quoted, _) = read(&["seed=6", "name=\"other\""]).expect("a scene");
    assert_eq!(quoted, other);
    // A section that the file does not have.
    let text = "name = 'n'\ntick_hz = 2000\nduration_s = 1\nseed = 1\n\
                head.whiskers_per_side = 1\nplant.kind = 'ideal'\n";
    let beside = ["plant.stiffness=0.5", "plant.obstacle_deg=[80, 90]"];
    let beside = beside.map(|text| text.parse().expect("KEY=VALUE"));
    let (scene, _) = Scene::from_str_with("s.toml", text, &beside).expect("a scene");
    let obstacle = scene.plant.obstacle.expect("an obstacle");
    assert_eq!(obstacle.obstacle_deg, [80.0, 90.0]);
}

#[test]
fn faults_are_those_of_the_file_under_the_name_of_what_was_given() {
    assert_eq!(
        complaint(&["head.whiskers_per_side=13"]),
        "--set head.whiskers_per_side=13: head.whiskers_per_side: found 13; \
         allowed: a whole number from 1 to 12"
    );
    let slip = complaint(&["rcp.gian=0.5"]);
    let start = "--set rcp.gian=0.5: rcp.gian: unknown key; did you mean `gain`?";
    assert!(slip.starts_with(start), "{slip}");
    let section = complaint(&["wisking.noise=0.5"]);
    assert!(
        section.contains("wisking: unknown key; did you mean `whisking`?"),
        "{section}"
    );
    let home = complaint(&["gain=0.5"]);
    assert!(
        home.starts_with("--set gain=0.5: gain: unknown key; it belongs to"),
        "{home}"
    );
    let syntax = complaint(&["rcp..gain=0.5"]);
    assert!(
        syntax.starts_with("--set rcp..gain=0.5: TOML syntax: "),
        "{syntax}"
    );
    // One line cannot smuggle in another.
    let two = complaint(&["rcp.gain=0.5\nseed = 9"]);
    assert!(two.contains("rcp.gain: found \""), "{two}");
}

#[test]
fn a_rule_that_an_override_breaks_is_told_where_it_is_broken() {
    let both = complaint(&["motor.min_deg=170", "motor.max_deg=20"]);
    assert!(
        both.starts_with("--set motor.min_deg=170: motor.min_deg: "),
        "{both}"
    );
    let mixed = complaint(&["seed=-1", "rcp.tau_s=0"]);
    let lines: Vec<_> = mixed.lines().collect();
    assert_eq!(lines.len(), 2, "{mixed}");
    assert!(
        lines[0].starts_with("--set seed=-1: seed: found -1"),
        "{mixed}"
    );
    assert!(
        lines[1].starts_with("--set rcp.tau_s=0: rcp.tau_s: found 0"),
        "{mixed}"
    );
}

#[test]
fn keys_are_found_again_where_they_stand() {
    let (_, places) = read(&["rcp.gain=0.25"]).expect("a scene");
    let line = 1 + FULL
        .lines()
        .position(|line| line.starts_with("tick_hz"))
        .expect("a line");
    assert_eq!(
        places.fault("tick_hz", "no"),
        format!("s.toml:{line}: tick_hz: no")
    );
    assert_eq!(
        places.fault("rcp.gain", "no"),
        "--set rcp.gain=0.25: rcp.gain: no"
    );
    // Left out: its section's line, or the file's first.
    let line = 1 + FULL
        .lines()
        .position(|line| line == "[plant]")
        .expect("a line");
    let left_out = places.fault("plant.shaft", "no");
    assert_eq!(left_out, format!("s.toml:{line}: plant.shaft: no"));
}
