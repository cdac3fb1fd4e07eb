//! `whisker deploy`, and what a module does that has a model deployed, or none.

use crate::common::{OTHER, Place, TWO_SIDES, bench_with, contains, scene, scenes};

/// The bench in the world of the main job, and how its flash is kept.
const IN_WORLD: &str = "--sim @bench.toml --world @textures.toml --flash board.flash";

const DEPLOY: &str = "deploy --sim @bench.toml --world @textures.toml --flash board.flash --model \
                      @models/textures.model";

fn model() -> Vec<u8> {
    std::fs::read(scenes("models/textures.model")).unwrap()
}

#[test]
fn a_model_that_is_deployed_decides_as_one_that_is_linked() {
    let place = Place::new();
    let log = |of: &str| place.done(&format!("log --seconds 6 {of}")).stdout;
    let without = log(IN_WORLD);
    let limit = "0.000 WARN  limit 34 no model to decide by (";
    assert!(without.starts_with(limit), "{without}");
    contains(&without, "\n0.000 WARN  - none was deployed");
    assert!(without.contains("touch left 1") && !without.contains("decision"));

    let ran = place.done(DEPLOY);
    let lines: Vec<&str> = ran.stdout.lines().collect();
    assert_eq!(lines.len(), 5, "{lines:?}");
    assert!(lines[0].ends_with("4 classes: smooth, p600, p240, carpet"));
    assert!(lines[1].starts_with("before, the module runs scene bench ("));
    assert!(lines[2].starts_with("before, the module decides by no model: none was deployed"));
    assert!(lines[3].starts_with("now it runs scene bench ("));
    // Samples count from the model's contact then.
    assert_ne!(lines[1].split_once("runs"), lines[3].split_once("runs"));
    let crc = u32::from_le_bytes(*model().last_chunk().unwrap());
    let decides = format!("decides by model {crc:08x}, 4 classes");
    assert_eq!(lines[4], format!("now it {decides}"));

    let deployed = log(IN_WORLD);
    let (first, rest) = deployed.split_once('\n').unwrap();
    assert_eq!(first, format!("0.000 INFO  {decides}"));
    assert_eq!(rest, log("--sim @textures.toml"));
    assert!(rest.matches("decision left ").count() > 10, "{rest}");
    let again = place.done(DEPLOY);
    again.prints("before, the module decides by model");
}

#[test]
fn flash_that_was_not_written_whole_is_refused_at_the_start() {
    let place = Place::new();
    place.done(DEPLOY);
    let whole = place.bytes("board.flash");
    assert_eq!(whole.len(), 124 * 1024);
    let with = |at: usize, bytes: &[u8]| {
        let mut flash = whole.clone();
        flash[at..at + bytes.len()].copy_from_slice(bytes);
        flash
    };
    let erased = "- none was deployed, or writing it was interrupted";
    for (flash, why) in [
        (with(1_000, &[!whole[1_000]]), "it is damaged"),
        (with(4, &[9]), "another version"),
        (with(3, &[0]), "is no model"),
        (with(0, &[0xFF; 8]), erased),
    ] {
        std::fs::write(place.path("board.flash"), flash).unwrap();
        let log = place.done(&format!("log --seconds 0.1 {IN_WORLD}"));
        log.prints(why);
    }
    place.write("board.flash", "short");
    let why = "found 5 bytes, allowed: 126976";
    place.refuses(&format!("log {IN_WORLD}"), why);
}

#[test]
fn what_does_not_fit_is_refused_before_anything_is_written() {
    let place = Place::new();
    let mut bytes = model();
    bytes[4] += 2;
    std::fs::write(place.path("newer.model"), &bytes).unwrap();
    let newer = format!("deploy {IN_WORLD} --model newer.model");
    place.refuses(&newer, "newer.model: model format version 4");
    assert!(!place.path("board.flash").exists());

    let bench = scene("bench.toml");
    let least = bench.replace("[classifier]\n", "[classifier]\ncontact_min = 0.2\n");
    place.write("least.toml", &least);
    let window = bench.replace("\"sequential\"", "\"window\"\nwindow = 7");
    place.write("window.toml", &window);
    let brings = "textures.toml:36: classifier.model: found, so the scene brings its model";
    let least = "classifier.contact_min: found 0.2; allowed: 0.05";
    for (scene, why) in [
        ("@textures.toml", brings),
        ("bench.toml", "bench.toml: it has no [classifier]"),
        ("least.toml", least),
        ("window.toml", "multiple of the block"),
    ] {
        let line = format!("deploy --sim {scene} --model @models/textures.model");
        place.refuses(&line, why);
    }
}

#[test]
fn a_recording_out_of_the_models_range_is_reported() {
    let place = Place::new();
    let rows = (16_000..16_100).map(|x| format!("felt,0,{x},8192\n"));
    let rows: String = rows.collect();
    place.write("other.csv", &format!("label,trial,x,y\n{rows}"));
    let ran = place.done(&format!("{DEPLOY} --data other.csv"));
    ran.warns("\"felt\" is none of the model's classes");
    ran.warns("other.csv:2: ");
}

#[test]
fn a_world_must_fit_the_module() {
    let place = Place::new();
    let why = "a world for two sides of whiskers, allowed: one for";
    place.refuses("log --sim @bench.toml --world @both.toml", why);
    // In free air nothing is touched.
    let log = place.done("log --seconds 3 --sim @bench.toml");
    log.prints("limit 34");
    let capture = "capture --sim @bench.toml --label smooth --out c.csv";
    place.refuses(capture, "--world SCENE");
}

/// What a module runs, as the last line of a deployment has it, and as `get` says it.
fn assert_runs(place: &Place, now: &str, get: &str) {
    assert!(now.starts_with("now it runs scene other ("), "{now}");
    let get = place.done(get).stdout;
    let first = now.replace("now it", "the module");
    assert_eq!(get.lines().next(), Some(&*first));
}

#[test]
fn a_scene_that_is_deployed_is_what_the_module_runs() {
    let place = Place::new();
    let other = bench_with(&[OTHER, ("gain = 0.7", "gain = 0.9")]);
    place.write("other.toml", &other);
    let ran = place.done("deploy --scene other.toml --sim bench.toml --seconds 0.1");
    let lines: Vec<&str> = ran.stdout.lines().collect();
    let [before, now] = lines[..] else {
        panic!("{lines:?}");
    };
    assert!(before.starts_with("before, the module runs scene bench ("));
    assert_runs(&place, now, "get --sim other.toml");

    let ran = place.run("deploy --scene other.toml --sim bench.toml --flash f");
    ran.warns("--flash keeps the model");
    place.write("wrong.toml", &other.replace("gain = 0.9", "gain = 900"));
    let wrong = "deploy --scene wrong.toml --sim bench.toml";
    place.refuses(wrong, "rcp.gain: found 900");
    place.refuses("deploy --sim bench.toml", "--scene <FILE>");
}

#[test]
fn a_scene_that_the_board_does_not_take_changes_nothing_in_it() {
    let place = Place::new();
    let board = "--emulated @bench.toml --flash board.flash";
    let other = bench_with(&[OTHER]);
    place.write("other.toml", &other);
    let ran = place.done(&format!("deploy --scene other.toml {board}"));
    let now = ran.stdout.lines().last().unwrap();
    let kept = place.bytes("board.flash");

    let two = bench_with(TWO_SIDES) + "[motor]\ndriver = \"six-step\"\n";
    let fault = "no.toml: motor.driver: found \"six-step\" on two sides; allowed on the \
                 NUCLEO-F446RE: \"h-bridge\" on two sides";
    let mute = other + "[telemetry]\nrtt = false\n";
    for (text, why) in [(two, fault), (mute, "telemetry.rtt: found false")] {
        place.write("no.toml", &text);
        place.refuses(&format!("deploy --scene no.toml {board}"), why);
    }
    assert_eq!(place.bytes("board.flash"), kept);
    assert_runs(&place, now, &format!("get --scene other.toml {board}"));
}

/// The second board of a head has no whisker on the left.
#[test]
fn a_board_of_a_head_stops_and_takes_another_scene() {
    let place = Place::new();
    let head = bench_with(TWO_SIDES).replace("[head]", "[head]\nnodes = 2");
    place.write("head.toml", &head);
    let (from, to) = OTHER;
    place.write("other.toml", &head.replace(from, to));
    let ran = place.done("deploy --sim head.toml --node 1 --scene other.toml");
    ran.prints("before, the module runs scene bench (");
    ran.prints("now it runs scene other (");
    let few = "by way of another board 100 records a second come";
    place.refuses("check --emulated head.toml --node 1 --out checked", few);
}
