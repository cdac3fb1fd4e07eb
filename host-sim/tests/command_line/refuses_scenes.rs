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

/// Where the limits stand is for the crate `config` to test.
#[test]
fn what_forward_euler_cannot_carry() {
    let few = IDEAL
        .replace("tick_hz = 2000", "tick_hz = 400")
        .replace("frequency_hz = 10.0", "frequency_hz = 25.0");
    let found = "s.toml: whisking.integrator: found \"euler\" at 25 Hz";
    refuses(few, &[found, "tick_hz at least 467"]);
}

#[test]
fn classifiers_that_cannot_be() {
    let scene = format!("{TEXTURED}{SEQUENTIAL}");
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
    ] {
        refuses(with(keys), &naming);
    }

    refuses(
        scene
            .replace("sequential", "window")
            .replace("threshold = 0.9", "window = 30"),
        &["s.toml:28: classifier.window", "30", "block of 20"],
    );
}

/// What a shaft has no sensor for is said by the key, with what it allows.
#[test]
fn a_stiffness_beyond_what_a_sensor_of_the_shaft_has() {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/whisker.toml");
    let place = Place::new();
    for stiffness in ["0", "0.000000001"] {
        let line = format!("run {scene} --out o --set plant.stiffness={stiffness}");
        let found = format!("plant.stiffness: found {stiffness},");
        place.refuses(&line, &[&found, "per degree"]);
    }
}

/// A tip that passes through what it touches is not simulated in silence.
#[test]
fn a_shaft_that_tapers_too_much_is_said() {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/whisker.toml");
    let place = Place::new();
    let run = |tip: &str| {
        let shaft = [
            "plant.shaft=own",
            "plant.length_m=0.1",
            "plant.hub_diameter_m=2e-3",
            &format!("plant.tip_diameter_m={tip}"),
            "plant.youngs_pa=2.3e9",
            "plant.density_kg_m3=1100",
            "plant.damping_ratio=0.05",
            "plant.follicle_n_m_rad=0.1",
            "duration_s=0.1",
            "plant.stiffness=0.01",
        ];
        let line = format!(
            "run {scene} --out o --no-plot --set {}",
            shaft.join(" --set ")
        );
        let ran = place.run(&line);
        assert_eq!(ran.status, Some(0), "{ran:?}");
        ran
    };
    assert!(run("4e-5").stderr.contains("it tapers by 50"));
    assert!(!run("1e-4").stderr.contains("it tapers"));
}

/// At a slant of 30 degrees a plate that goes on cuts the circle of the tip again 120 further on, and
/// holds a whisker at rest (50, or 410) from 290 on; by a run, 250 does not and 300 does.
#[test]
fn a_plate_that_reaches_round_to_rest_is_said() {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/whisker.toml");
    let place = Place::new();
    let says = |obstacle_deg: &str, more: &str| {
        let set = format!("--set plant.obstacle_deg=[{obstacle_deg}] --set duration_s=0.1 {more}");
        let ran = place.run(&format!("run {scene} --out o --no-plot {set}"));
        assert_eq!(ran.status, Some(0), "{ran:?}");
        ran.stderr.contains("reaches round to the whisker at rest")
    };
    for (obstacle_deg, is_said) in [("115", false), ("250", false), ("300", true), ("340", true)] {
        assert_eq!(says(obstacle_deg, ""), is_said, "{obstacle_deg}");
    }
    assert!(!says("340", "--set plant.begins_m=-0.01"), "it ends");
}

/// Where no model says which classes there are.
#[test]
fn priors_that_are_more_than_one_together() {
    let scene = |prior: &str| {
        format!("{TEXTURED}[classifier]\nrule = \"sequential\"\nthreshold = 0.9\nprior = {prior}\n")
    };
    let place = Place::with(&[("s.toml", &scene("{ smooth = 0.5, p240 = 0.75 }"))]);
    place.refuses(
        "run s.toml --out o",
        &["classifier.prior: found a sum of 1.25"],
    );
    place.write("s.toml", scene("{ smooth = 0.5, p240 = 0.5 }"));
    assert_eq!(place.run("run s.toml --out o --no-plot").status, Some(0));
}
