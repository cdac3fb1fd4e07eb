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
    Place::with(&[("folder/file", "")]).refuses_each(
        "run none.toml | none.toml | cannot be read
         run folder | folder | cannot be read",
    );
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
    // The file allows the first, but it is nearer to 1 than evidence is counted. Classes are those
    // of the model, smooth and carpet.
    let table = r#"sequential: threshold = 0.9999999999999 | 28: classifier.threshold | 1 - 1e-12
        sequential: threshold = 0.9\nprior = { p600 = 0.5 } | 29: classifier.prior: found "p600" | smooth, carpet
        sequential: threshold = 0.9\nprior = { smooth = 0.5, carpet = 0.6 } | 29: classifier.prior: found a sum of 1.1 | 1, as every
        sequential: threshold = 0.9\nthresholds = { p600 = 0.9 } | 29: classifier.thresholds | smooth, carpet
        window: window = 30 | 28: classifier.window | 30 | block of 20"#;
    for row in table.lines() {
        let cells: Vec<&str> = row.trim().split(" | ").collect();
        let (rule, keys) = cells[0].split_once(": ").unwrap();
        let scene = format!("{TEXTURED}{SEQUENTIAL}").replace("sequential", rule);
        let scene = scene.replace("threshold = 0.9", &keys.replace("\\n", "\n"));
        refuses(scene, &[&["s.toml:"], &cells[1..]].concat());
    }
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
        let mut line = format!("run {scene} --out o --no-plot --set duration_s=0.1");
        let shaft = "shaft=own length_m=0.1 hub_diameter_m=2e-3 youngs_pa=2.3e9 \
            density_kg_m3=1100 damping_ratio=0.05 follicle_n_m_rad=0.1 stiffness=0.01";
        for key in shaft
            .split(' ')
            .chain([format!("tip_diameter_m={tip}").as_str()])
        {
            line = format!("{line} --set plant.{key}");
        }
        place.warned(&line)
    };
    assert!(run("4e-5").contains("it tapers by 50"));
    assert!(!run("1e-4").contains("it tapers"));
}

/// At a slant of 30 degrees a plate that goes on cuts the circle of the tip again 120 further on, and
/// holds a whisker at rest (50, or 410) from 290 on; by a run, 250 does not and 300 does.
#[test]
fn a_plate_that_reaches_round_to_rest_is_said() {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/whisker.toml");
    let place = Place::new();
    let says = |obstacle_deg: &str, more: &str| {
        let set = format!("--set plant.obstacle_deg=[{obstacle_deg}] --set duration_s=0.1 {more}");
        let said = place.warned(&format!("run {scene} --out o --no-plot {set}"));
        said.contains("reaches round to the whisker at rest")
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
    let sum = "classifier.prior: found a sum of 1.25";
    place.refuses("run s.toml --out o", &[sum]);
    place.write("s.toml", scene("{ smooth = 0.5, p240 = 0.5 }"));
    place.warned("run s.toml --out o --no-plot");
}
