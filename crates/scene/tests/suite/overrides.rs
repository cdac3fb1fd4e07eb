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
    let out_of_range = "head.whiskers_per_side: found 13; allowed: a whole number from 1 to 12";
    let cases = [
        ("head.whiskers_per_side=13", out_of_range),
        (
            "rcp.gian=0.5",
            "rcp.gian: unknown key; did you mean `gain`?",
        ),
        (
            "wisking.noise=0.5",
            "wisking: unknown key; did you mean `whisking`?",
        ),
        ("gain=0.5", "gain: unknown key; it belongs to"),
        ("rcp..gain=0.5", "TOML syntax: "),
        // One line cannot smuggle in another.
        ("rcp.gain=0.5\nseed = 9", "rcp.gain: found \""),
    ];
    for (given, fault) in cases {
        let complaint = complaint(&[given]);
        assert!(
            complaint.starts_with(&format!("--set {given}: {fault}")),
            "{complaint}"
        );
    }
    // Several have a line each, and a rule has the one that breaks it.
    let mixed = complaint(&[
        "seed=-1",
        "rcp.tau_s=0",
        "motor.min_deg=170",
        "motor.max_deg=20",
    ]);
    let starts = [
        "--set seed=-1: seed: found -1",
        "--set rcp.tau_s=0: rcp.tau_s: found 0",
        "--set motor.min_deg=170: motor.min_deg: ",
    ];
    assert_eq!(mixed.lines().count(), starts.len(), "{mixed}");
    for (line, start) in mixed.lines().zip(starts) {
        assert!(line.starts_with(start), "{mixed}");
    }
}

#[test]
fn keys_are_found_again_where_they_stand() {
    let (_, places) = read(&["rcp.gain=0.25"]).expect("a scene");
    let line_of = |start| {
        let before = FULL.lines().position(|line| line.starts_with(start));
        1 + before.expect("a line")
    };
    let of_rate = format!("s.toml:{}: tick_hz: no", line_of("tick_hz"));
    assert_eq!(places.fault("tick_hz", "no"), of_rate);
    let beside = "--set rcp.gain=0.25: rcp.gain: no";
    assert_eq!(places.fault("rcp.gain", "no"), beside);
    // Left out: its section's line, or the file's first.
    let left_out = format!("s.toml:{}: plant.shaft: no", line_of("[plant]"));
    assert_eq!(places.fault("plant.shaft", "no"), left_out);
    let (_, places) = read(&["motor.stop_deg=20"]).expect("a scene");
    let idle =
        "--set motor.stop_deg=20: motor.stop_deg: has no effect; used only where rest = \"find\"";
    assert!(places.idle().eq([idle]));
}
