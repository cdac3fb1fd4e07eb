//! `whisker bringup` of an emulated board, with each of its findings provoked once.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use crate::common::{Place, scenes};

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
        let at_s = if event.starts_with("at_s") {
            ""
        } else {
            "at_s = 0.0\n"
        };
        format!("[[event]]\n{at_s}{event}\n")
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
    let json = place.text("seen.json");
    assert!(json.contains("\"findings\""), "{json}");
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
    let names: Vec<&str> = steps
        .iter()
        .map(|step| step["step"].as_str().unwrap())
        .collect();
    let all = [
        "module", "frames", "rest", "rate", "noise", "encoder", "motor",
    ];
    assert_eq!(names, all);
    assert_eq!(steps[1]["seen"]["sum_rule"], "b1-b6");
}

/// What is known of the sensor from one source or none: each is another than the board takes it for.
#[test]
fn a_sensor_that_is_another_than_guessed_is_found() {
    for (part, found) in [
        ("sum_rule = 'b0-b6'", &["sensor.sum_rule = \"b0-b6\""][..]),
        (
            "sum_rule = 'not-b1-b6'\nbyte_order = 'high-first'",
            &[
                "sensor.sum_rule = \"not-b1-b6\"",
                "sensor.byte_order = \"high-first\"",
            ],
        ),
        (
            "sum_rule = 'not-b0-b6'\nwords = 'xyz'",
            &["sensor.sum_rule = \"not-b0-b6\"", "sensor.words = \"xyz\""],
        ),
        ("report = 128", &["the sensor reports field too low"]),
    ] {
        finds(&[&format!("kind = 'sensor-part'\n{part}")], "frames", found);
    }
    let slow = "kind = 'sensor-part'\nupdate_hz = 500";
    finds(&[slow], "rate", &["new readings a second: set tick_hz"]);
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
    finds(
        &[off],
        "motor",
        &["the motor's supply and its emergency switch"],
    );
}

#[test]
fn a_program_of_another_scene_is_refused() {
    let place = Place::new();
    let program = program().display();
    let bench = std::fs::read_to_string(scenes("bench.toml")).unwrap();
    for (from, to, why) in [
        ("\"bench\"", "\"other\"", "allowed: that of \"other\""),
        (
            "tick_hz    = 2000",
            "tick_hz = 1000",
            "found tick_hz = 2000, allowed: 1000",
        ),
    ] {
        place.write("other.toml", &bench.replace(from, to));
        place.refuses(
            &format!("log --emulated other.toml --program {program}"),
            why,
        );
    }
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
    place.refuses(
        "bringup --sim @bringup.toml --scenario befalls.toml",
        "cannot be used with",
    );
}
