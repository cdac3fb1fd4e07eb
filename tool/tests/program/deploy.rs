//! `whisker deploy`, and what a module does that has a model deployed, or none.

use std::path::PathBuf;

use crate::common::{BENCH, Place, scenes, textures};

/// The bench in the world of the main job, and how its flash is kept.
fn bench() -> String {
    let (bench, world) = (scenes("bench.toml"), textures());
    format!(
        "--sim {} --world {} --flash board.flash",
        bench.display(),
        world.display()
    )
}

fn model() -> PathBuf {
    scenes("models/textures.model")
}

#[test]
fn a_model_that_is_deployed_decides_as_one_that_is_linked() {
    let place = Place::new();
    let (bench, model) = (bench(), model());
    let log = |of: &str| place.done(&format!("log --seconds 6 {of}")).stdout;
    let without = log(&bench);
    let limit = "0.000 WARN  limit 34 no model to decide by (";
    assert!(without.starts_with(limit), "{without}");
    let why = without.lines().nth(1).unwrap();
    assert!(
        why.starts_with("0.000 WARN  - none was deployed"),
        "{without}"
    );
    assert!(without.contains("touch left 1") && !without.contains("decision"));

    let ran = place.done(&format!("deploy {bench} --model {}", model.display()));
    let lines: Vec<&str> = ran.stdout.lines().collect();
    assert_eq!(lines.len(), 5, "{lines:?}");
    assert!(lines[0].ends_with("4 classes: smooth, p600, p240, carpet"));
    assert!(lines[1].starts_with("before, the module runs scene bench ("));
    assert!(lines[2].starts_with("before, the module decides by no model: none was deployed"));
    assert!(lines[3].starts_with("now it runs scene bench ("));
    // Samples count from the model's contact then.
    assert_ne!(lines[1].split_once("runs"), lines[3].split_once("runs"));
    let crc = std::fs::read(&model).unwrap();
    let crc = u32::from_le_bytes(*crc.last_chunk().unwrap());
    assert_eq!(
        lines[4],
        format!("now it decides by model {crc:08x}, 4 classes")
    );

    let deployed = log(&bench);
    let (first, rest) = deployed.split_once('\n').unwrap();
    assert_eq!(
        first,
        format!("0.000 INFO  decides by model {crc:08x}, 4 classes")
    );
    assert_eq!(rest, log(&format!("--sim {}", textures().display())));
    assert!(rest.matches("decision left ").count() > 10, "{rest}");
    let again = place.done(&format!("deploy {bench} --model {}", model.display()));
    assert!(again.stdout.contains("before, the module decides by model"));
}

#[test]
fn flash_that_was_not_written_whole_is_refused_at_the_start() {
    let place = Place::new();
    let (bench, model) = (bench(), model());
    place.done(&format!("deploy {bench} --model {}", model.display()));
    let whole = std::fs::read(place.path("board.flash")).unwrap();
    assert_eq!(whole.len(), 124 * 1024);
    let refused = |at: usize, byte: u8, why: &str| {
        let mut flash = whole.clone();
        flash[at] = byte;
        std::fs::write(place.path("board.flash"), flash).unwrap();
        let log = place.done(&format!("log --seconds 0.1 {bench}")).stdout;
        assert!(log.contains(why), "{log}");
    };
    refused(1_000, !whole[1_000], "it is damaged");
    refused(4, 9, "another version");
    refused(3, 0, "is no model");
    let header = [0xFF; 8];
    let flash = [&header, &whole[8..]].concat();
    std::fs::write(place.path("board.flash"), flash).unwrap();
    let log = place.done(&format!("log --seconds 0.1 {bench}")).stdout;
    assert!(
        log.contains("- none was deployed, or writing it was interrupted"),
        "{log}"
    );
    place.write("board.flash", "short");
    let said = place.refused(&format!("log {bench}"));
    assert!(said.contains("found 5 bytes, allowed: 126976"), "{said}");
}

#[test]
fn what_does_not_fit_is_refused_before_anything_is_written() {
    let place = Place::new();
    let (bench, model) = (bench(), model());
    let mut bytes = std::fs::read(&model).unwrap();
    bytes[4] += 1;
    std::fs::write(place.path("newer.model"), &bytes).unwrap();
    let said = place.refused(&format!("deploy {bench} --model newer.model"));
    assert!(
        said.contains("newer.model: model format version 3"),
        "{said}"
    );
    assert!(!place.path("board.flash").exists());

    let linked = textures();
    let said = place.refused(&format!(
        "deploy --sim {} --model {}",
        linked.display(),
        model.display()
    ));
    assert!(
        said.contains("textures.toml:34: classifier.model: found, so the scene brings its model"),
        "{said}"
    );
    let said = place.refused(&format!(
        "deploy --sim bench.toml --model {}",
        model.display()
    ));
    assert!(
        said.contains("bench.toml: it has no [classifier]"),
        "{said}"
    );

    let bench = std::fs::read_to_string(scenes("bench.toml")).unwrap();
    let deaf = bench.replace("[classifier]\n", "[classifier]\ncontact_min = 0.2\n");
    place.write("deaf.toml", &deaf);
    let said = place.refused(&format!(
        "deploy --sim deaf.toml --model {}",
        model.display()
    ));
    assert!(
        said.contains("classifier.contact_min: found 0.2; allowed: 0.05"),
        "{said}"
    );
    let window = bench.replace("\"sequential\"", "\"window\"\nwindow = 7");
    place.write("window.toml", &window);
    let said = place.refused(&format!(
        "deploy --sim window.toml --model {}",
        model.display()
    ));
    assert!(said.contains("multiple of the block"), "{said}");
}

#[test]
fn a_recording_out_of_the_models_range_is_reported() {
    let place = Place::new();
    let rows = (16_000..16_100).map(|x| format!("felt,0,{x},8192\n"));
    let rows: String = rows.collect();
    place.write("other.csv", &format!("label,trial,x,y\n{rows}"));
    let ran = place.done(&format!(
        "deploy {} --model {} --data other.csv",
        bench(),
        model().display()
    ));
    assert!(
        ran.stderr
            .contains("\"felt\" is none of the model's classes")
    );
    assert!(ran.stderr.contains("other.csv:2: "), "{}", ran.stderr);
}

#[test]
fn a_world_must_fit_the_module() {
    let place = Place::new();
    let bench = scenes("bench.toml");
    let in_world = |world: &str| {
        let world = scenes(world);
        place.refused(&format!(
            "log --sim {} --world {}",
            bench.display(),
            world.display()
        ))
    };
    assert!(in_world("both.toml").contains("a world for two sides of whiskers, allowed: one for"));
    // In free air nothing is touched.
    let log = place.done(&format!("log --seconds 3 --sim {}", bench.display()));
    assert!(log.stdout.contains("limit 34"), "{}", log.stdout);
    let said = place.refused(&format!(
        "capture --sim {} --label smooth --out c.csv",
        bench.display()
    ));
    assert!(said.contains("--world SCENE"), "{said}");
}

#[test]
fn a_scene_that_is_deployed_is_what_the_module_runs() {
    let place = Place::new();
    let other = BENCH
        .replace("\"bench\"", "\"other\"")
        .replace("gain = 0.7", "gain = 0.9");
    place.write("other.toml", &other);
    let ran = place.done("deploy --scene other.toml --sim bench.toml --seconds 0.1");
    let lines: Vec<&str> = ran.stdout.lines().collect();
    let [before, now] = lines[..] else {
        panic!("{lines:?}");
    };
    assert!(before.starts_with("before, the module runs scene bench ("));
    assert!(now.starts_with("now it runs scene other ("));
    let get = place.done("get --sim other.toml").stdout;
    assert_eq!(
        get.lines().next(),
        Some(&*now.replace("now it", "the module"))
    );

    let said = place
        .run("deploy --scene other.toml --sim bench.toml --flash f")
        .stderr;
    assert!(said.contains("--flash keeps the model"), "{said}");
    place.write("wrong.toml", &other.replace("gain = 0.9", "gain = 900"));
    let said = place.refused("deploy --scene wrong.toml --sim bench.toml");
    assert!(said.contains("rcp.gain: found 900"), "{said}");
    let said = place.refused("deploy --sim bench.toml");
    assert!(said.contains("--scene <FILE>"), "{said}");
}

#[test]
fn a_scene_that_the_board_does_not_take_changes_nothing_in_it() {
    let place = Place::new();
    let board = "--emulated bench.toml --flash board.flash";
    let other = BENCH.replace("\"bench\"", "\"other\"");
    place.write("other.toml", &other);
    let ran = place.done(&format!("deploy --scene other.toml {board}"));
    let now = ran.stdout.lines().last().unwrap();
    assert!(now.starts_with("now it runs scene other ("), "{now}");
    let kept = std::fs::read(place.path("board.flash")).unwrap();

    let two = BENCH
        .replace("sides = \"left\"", "sides = \"both\"")
        .replace("start = [[1.0, 0.0]]", "start = [[1.0, 0.0], [1.0, 0.0]]")
        .replace("obstacle_deg = [100.0]", "obstacle_deg = [100.0, 100.0]");
    place.write(
        "two.toml",
        &format!("{two}[motor]\ndriver = \"six-step\"\n"),
    );
    let said = place.refused(&format!("deploy --scene two.toml {board}"));
    let fault = "two.toml: motor.driver: found \"six-step\" on two sides; allowed on the \
                 NUCLEO-F446RE: \"h-bridge\" on two sides";
    assert!(said.contains(fault), "{said}");
    let mute = format!("{other}[telemetry]\nrtt = false\n");
    place.write("mute.toml", &mute);
    let said = place.refused(&format!("deploy --scene mute.toml {board}"));
    assert!(said.contains("telemetry.rtt: found false"), "{said}");
    assert_eq!(std::fs::read(place.path("board.flash")).unwrap(), kept);
    let get = place
        .done(&format!("get --scene other.toml {board}"))
        .stdout;
    assert_eq!(
        get.lines().next(),
        Some(&*now.replace("now it", "the module"))
    );
}
