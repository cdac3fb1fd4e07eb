//! `whisker bringup` of an emulated board, with each of its findings provoked once.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use crate::common::{Place, scene};

/// The program of the bench's scene, which is built by the first that asks for it.
fn program() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        let place = Place::new();
        let ran = place.done("bringup --emulated @bench.toml --yes --steps module");
        ran.prints("start 1 since power-up, for power-up; last fault: 0\n");
        ran.prints("findings: 0\n");
        // It is kept by the sum of its configuration, which the module names too.
        let (_, after) = ran.stdout.split_once("runs scene bench (").unwrap();
        let name = format!("nucleo-f446re-{}-00000000.elf", &after[..8]);
        let built = Path::new(env!("CARGO_BIN_EXE_whisker")).ancestors().nth(2);
        built.unwrap().join("scenes").join(name)
    })
}

/// The command line of these steps of a bring-up that asks nothing, where this befalls the board.
fn bringup(place: &Place, events: &[&str], steps: &str) -> String {
    let events = events.iter().map(|event| {
        let begins = ["at_s = 0.0\n", ""][usize::from(event.starts_with("at_s"))];
        format!("[[event]]\n{begins}{event}\n")
    });
    place.write("befalls.toml", &events.collect::<Vec<_>>().concat());
    let program = program().display();
    format!(
        "bringup --emulated @bench.toml --program {program} --scenario befalls.toml --frames 60 --yes \
         --motor --json seen.json {steps}"
    )
}

fn finds(events: &[&str], steps: &str, found: &[&str]) {
    let place = Place::new();
    let ran = place.fails(&bringup(&place, events, &format!("--steps {steps}")));
    for found in found {
        ran.prints(found);
    }
    ran.prints(&format!("findings: {}\n", found.len()));
    place.holds("seen.json", "\"findings\"");
}

/// A hand that turns the whisker forward, which takes it for a moment.
const HAND: &str = "at_s = 1.0\nfor_s = 0.08\nkind = 'hand'\ntorque_nm = 0.0005";
const SOON: &str = "at_s = 0.2\nfor_s = 0.08\nkind = 'hand'\ntorque_nm = 0.0005";

#[test]
fn a_board_that_is_well_passes_every_step() {
    let place = Place::new();
    let ran = place.done(&bringup(&place, &[HAND], ""));
    for said in [
        "clock: the one that the board is made for\n",
        "the sensor answers, as the scene has it\n",
        "/SS is high for 64 us between two frames at tick_hz = 2000; 0 of 60",
        "336 us at 1000 Hz",
        "the sensor has a new reading for each tick",
        "quiet: at most 9 codes\n",
        "forward counts up, as it must",
        "motor and encoder agree",
        "findings: 0\n",
    ] {
        ran.prints(said);
    }
    let json: serde_json::Value = serde_json::from_str(&place.text("seen.json")).unwrap();
    let steps = json["steps"].as_array().unwrap();
    let names = steps.iter().map(|step| step["step"].as_str().unwrap());
    let all = "module frames rest rate noise encoder motor";
    assert!(names.eq(all.split(' ')), "{json}");
    assert_eq!(steps[1]["seen"]["sum_rule"], "b1-b6");
    let second = steps[1]["saw"][1].as_str();
    assert!(
        second.is_some_and(|line| line.starts_with("sum ")),
        "{json}"
    );
}

/// What is known of the sensor from one source or none: each is another than the board takes it for.
#[test]
fn a_sensor_that_is_another_than_guessed_is_found() {
    let part = |key: &str| format!("kind = 'sensor-part'\n{key}");
    let keys = "sum_rule = 'not-b1-b6'\nbyte_order = 'high-first'\nwords = 'xyz'";
    let found = [
        "sensor.sum_rule = \"not-b1-b6\"",
        "sensor.byte_order = \"high-first\"",
        "sensor.words = \"xyz\"",
    ];
    finds(&[&part(keys)], "frames", &found);
    let low = &["the sensor reports field too low"];
    finds(&[&part("report = 128")], "frames", low);
    let slow = &["new readings a second: set tick_hz"];
    finds(&[&part("update_hz = 500")], "rate", slow);
}

#[test]
fn a_sensor_that_rests_for_longer_is_found_and_reads_clean_in_the_scene_for_it() {
    let rests = "kind = 'sensor-part'\nrest_us = 300";
    finds(&[rests], "frames,rest", &["64 us may be too short a rest"]);
    let place = Place::new();
    let program = program().display();
    place.done(&format!(
        "deploy --emulated @bench.toml --program {program} --scene @bringup.toml --flash kept.flash"
    ));
    let line = bringup(&place, &[rests], "--steps frames,rest,rate");
    let line = line.replace("@bench.toml", "@bringup.toml --flash kept.flash");
    let ran = place.done(&line);
    ran.prints("a rest of 336 us is enough for this sensor");
}

#[test]
fn the_shortest_rest_that_is_enough_is_found() {
    let place = Place::new();
    let rests = "kind = 'sensor-part'\nrest_us = 100";
    let ran = place.done(&bringup(&place, &[rests], "--find-rest @bench.toml"));
    for said in [
        "120 us at 1800 Hz: 60 of 60 frames were answered\n",
        "a rest of 120 us is enough. The module is left with this scene and tick_hz = 1800",
        "findings: 0\n",
    ] {
        ran.prints(said);
    }
}

#[test]
fn a_sensor_that_does_not_answer_is_found() {
    let nothing = &["so nothing answers"][..];
    for (kind, found) in [
        ("sensor-gone", nothing),
        ("select-stuck", nothing),
        ("sensor-unpowered", &["the sensor has no supply"]),
    ] {
        finds(&[&format!("kind = '{kind}'")], "frames,rest", found);
    }
}

#[test]
fn an_encoder_and_a_motor_that_are_the_wrong_way_round_are_found() {
    let swapped = "kind = 'encoder-reversed'";
    let exchange = &["exchange the encoder's channels A and B"];
    // The motor is left alone then.
    finds(&[swapped, SOON], "encoder,motor", exchange);
    let reversed = "kind = 'motor-reversed'";
    let exchange = &["exchange the motor's two wires: the encoder is right"];
    finds(&[reversed, SOON], "encoder,motor", exchange);
    let off = "kind = 'supply'\nvolts = 0.0";
    let supply = &["the motor's supply and its emergency switch"];
    finds(&[off], "motor", supply);
}

#[test]
fn a_program_of_another_scene_is_refused() {
    let place = Place::new();
    let program = program().display();
    let hz = "found tick_hz = 2000, allowed: 1000";
    for (from, to, why) in [
        ("\"bench\"", "\"other\"", "allowed: that of \"other\""),
        ("tick_hz    = 2000", "tick_hz = 1000", hz),
    ] {
        place.write("other.toml", &scene("bench.toml").replace(from, to));
        let log = format!("log --emulated other.toml --program {program}");
        place.refuses(&log, why);
    }
}

/// A simulated sensor sends as its scene has it.
#[test]
fn a_sensor_is_held_against_the_scene_that_the_module_runs() {
    let place = Place::new();
    let keys = "[sensor]\nsum_rule = \"not-b0-b6\"\nbyte_order = \"high-first\"";
    place.write(
        "other.toml",
        &scene("bench.toml").replacen("[sensor]", keys, 1),
    );
    let ran = place.done("bringup --sim other.toml --frames 60 --yes --steps frames");
    ran.prints("sum rule not-b0-b6; ");
    ran.prints("means: the sensor answers, as the scene has it\n");
}

#[test]
fn a_clock_that_does_not_come_is_found() {
    finds(&["kind = 'clock-late'"], "module", &["fault or limit 37, "]);
}

#[test]
fn an_empty_keyboard_is_no_answer() {
    let place = Place::new();
    let ran = place.fails("bringup --sim @bringup.toml --frames 60");
    ran.warns("standard input was closed before an answer came");
    let ran = place.done("bringup --sim @bringup.toml --frames 60 --yes");
    ran.prints("not done: no yes was given");
    ran.prints("not done: no hand turns a simulated whisker");
    let scenario = "bringup --sim @bringup.toml --scenario befalls.toml";
    place.refuses(scenario, "cannot be used with");
}
