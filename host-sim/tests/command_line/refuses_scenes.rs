//! Scenes that are wrong: status 2, file, line and key, and nothing written.

use crate::common::{IDEAL, Place, SEQUENTIAL, TEXTURED, model};

#[track_caller]
fn refuses(scene: impl AsRef<[u8]>, naming: &[&str]) {
    let place = Place::new();
    place.write("s.toml", scene);
    place.write("the.model", model(2, 20, true));
    place.refuses_to_write("run s.toml", naming);
}

#[test]
fn files_that_are_no_scene() {
    let place = Place::with(&[("folder/file", "")]);
    place.refuses_to_write("run none.toml", &["none.toml", "cannot be read"]);
    place.refuses_to_write("run folder", &["folder", "cannot be read"]);
    refuses("", &["s.toml:1: ", "tick_hz"]);
    refuses(b"name = \"\xff\"\n", &["s.toml: cannot be read", "UTF-8"]);
    refuses(b"\0\0\0\0", &["s.toml:1: TOML syntax"]);
    refuses("name = \n", &["s.toml:1: TOML syntax"]);
    refuses(model(2, 20, true), &["s.toml"]);
}

#[test]
fn values_that_are_out_of_place() {
    // What stands in the scene, what takes its place, what is said of it.
    let cases = r#"
tick_hz = 2000 -> tick_hertz = 2000 -> s.toml:2: tick_hertz, did you mean `tick_hz`
tick_hz = 2000 -> tick_hz = 199 -> s.toml:2: tick_hz: found 199, 200
tick_hz = 2000 -> tick_hz = "2000" -> s.toml:2: tick_hz
tick_hz = 2000 -> -> tick_hz
duration_s = 0.1 -> duration_s = nan -> s.toml:3: duration_s: found nan
duration_s = 0.1 -> duration_s = 1e-9 -> s.toml:3: duration_s
seed = 1 -> seed = -1 -> s.toml:4: seed: found -1
whiskers_per_side = 2 -> whiskers_per_side = 13 -> s.toml:6: head.whiskers_per_side
[whisking] -> [wisking] -> s.toml:7: wisking, did you mean `whisking`
"euler" -> "eular" -> s.toml:9: whisking.integrator, did you mean "euler"
gain = 1.0 -> gain = [1.0, 1.0, 1.0] -> s.toml:12: whisking.gain
[0.6, 0.5]] -> [0.6, 0.5, 1.0]] -> s.toml:13: whisking.start
tau_s = 0.02 -> tau_s = 0 -> s.toml:16: rcp.tau_s
[80.0, 90.0] -> [80.0] -> s.toml:19: plant.obstacle_deg
stiffness = 0.1 -> -> stiffness"#;
    for case in cases.trim_start().lines() {
        let mut parts = case.split("->").map(str::trim);
        let [from, to, said] = [(); 3].map(|()| parts.next().unwrap());
        let naming: Vec<&str> = said.split(", ").collect();
        assert!(IDEAL.contains(from), "{from}");
        refuses(IDEAL.replacen(from, to, 1), &naming);
    }
}

#[test]
fn every_fault_is_reported_at_once() {
    let scene = IDEAL.replace("2000", "2").replace("= 0.7", "= -0.7");
    refuses(scene, &["s.toml:2: tick_hz", "s.toml:15: rcp.gain"]);
}

#[test]
fn classifiers_that_cannot_be() {
    let scene = format!("{TEXTURED}{SEQUENTIAL}");
    let line = |key: &str| {
        let at = scene.lines().position(|line| line.starts_with(key));
        format!("s.toml:{}: classifier.{key}", at.unwrap() + 1)
    };
    for threshold in ["0", "1", "1.5", "-0.5", "nan", "inf"] {
        let found = format!("found {threshold}");
        refuses(
            scene.replace("threshold = 0.9", &format!("threshold = {threshold}")),
            &[&line("threshold"), &found],
        );
    }
    refuses(scene.replace("threshold = 0.9\n", ""), &["threshold"]);
    refuses(scene.replace("sequential", "serial"), &[&line("rule")]);
    // The file allows it, but it is nearer to 1 than evidence is counted.
    refuses(
        scene.replace("threshold = 0.9", "threshold = 0.9999999999999"),
        &["s.toml:28: classifier.threshold", "1 - 1e-12"],
    );

    // Classes are those of the model, smooth and carpet.
    let with = |keys: &str| scene.replace("threshold = 0.9", &format!("threshold = 0.9\n{keys}"));
    for (keys, naming) in [
        (
            "prior = { p600 = 0.5 }",
            [
                "s.toml:29: classifier.prior: found \"p600\"",
                "smooth, carpet",
            ],
        ),
        (
            "prior = { smooth = 0.5, carpet = 0.6 }",
            [
                "s.toml:29: classifier.prior: found a sum of 1.1",
                "1, as every",
            ],
        ),
        (
            "thresholds = { p600 = 0.9 }",
            ["s.toml:29: classifier.thresholds", "smooth, carpet"],
        ),
        (
            "cost_error = 5\ncost_delay_per_s = 1",
            [
                "s.toml:28: classifier.threshold: found with cost_error",
                "either",
            ],
        ),
    ] {
        refuses(with(keys), &naming);
    }

    let window = |samples: &str| {
        scene
            .replace("sequential", "window")
            .replace("threshold = 0.9", &format!("window = {samples}"))
    };
    refuses(window("0"), &["classifier.window: found 0"]);
    refuses(
        window("30"),
        &["s.toml:28: classifier.window", "30", "block of 20"],
    );
    refuses(scene.replace("sequential", "window"), &["window"]);
}
