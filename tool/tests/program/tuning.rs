//! `whisker set`, `get` and `save`.

use crate::common::{BENCH, OTHER, Place, Ran, scene, scenes};

/// The rows of a table after the motor is armed.
fn later(table: &str) -> Vec<&str> {
    let rows = table.lines().skip_while(|row| !row.starts_with("901,"));
    rows.collect()
}

/// Whether one of the lines begins with these words.
#[track_caller]
fn assert_row(ran: &Ran, words: &str) {
    let is_it = |line: &str| {
        let mut found = line.split_whitespace();
        words.split(' ').all(|word| found.next() == Some(word))
    };
    assert!(ran.stdout.lines().any(is_it), "{words}: {}", ran.stdout);
}

#[test]
fn a_key_that_is_set_before_the_motor_runs_is_the_scene_s() {
    let place = Place::new();
    let scene = |kp: f64| format!("{BENCH}[motor]\narm = \"on-command\"\nkp = {kp}\n");
    place.write("old.toml", &scene(0.05));
    place.write("new.toml", &scene(0.08));
    place.write("arm.txt", "0.4 arm\n");
    place.write("set.txt", "0.1 set motor.kp 0.08\n0.4 arm\n");
    let table = |scene: &str, script: &str| {
        let records = format!("records --sim {scene}.toml --script {script}.txt");
        let ran = place.done(&format!("{records} --seconds 2 --out {scene}-{script}.csv"));
        (ran.stdout, place.text(&format!("{scene}-{script}.csv")))
    };
    let (_, expected) = table("new", "arm");
    let (said, found) = table("old", "set");
    assert!(said.contains("set motor.kp 0.08: done"), "{said}");
    let (_, untouched) = table("old", "arm");
    assert_eq!(later(&expected).len(), 3_100);
    assert!(later(&found) == later(&expected));
    assert!(later(&found) != later(&untouched));
}

#[test]
fn it_says_what_differs() {
    let place = Place::new();
    let ran = place.done("set motor.kp=0.08 rcp.tau_s=0.2 --sim bench.toml");
    assert_row(&ran, "motor.kp 0.05 0.08 differs");
    assert_row(&ran, "rcp.tau_s 0.125 0.2 differs");
    let ran = place.done("get --sim bench.toml");
    assert!(!ran.stdout.contains("differs"), "{}", ran.stdout);
    ran.prints("motor.approach_deg_s");
    // Its scene has no part for these.
    for absent in ["cia.gain", "classifier.threshold", "motor.homing_duty"] {
        assert!(!ran.stdout.contains(absent), "{}", ran.stdout);
    }
}

/// By name, though a module knows its classes by number.
#[test]
fn priors_and_thresholds_of_classes_are_set_by_name() {
    let place = Place::new();
    let models = format!("\"{}/", scenes("models").display());
    let own = scene("textures.toml").replace("\"models/", &models);
    place.write("own.toml", &own);
    let set = "classifier.prior={smooth=0.7} classifier.thresholds={carpet=0.999,p600=0.99}";
    let ran = place.done(&format!("set {set} --sim own.toml"));
    assert_row(&ran, "classifier.thresholds - {carpet=0.999,p600=0.99}");
    assert_row(&ran, "classifier.prior - {smooth=0.7}");
    // What was set stays, whatever is set then.
    let more = "0.1 set classifier.prior {smooth=0.7}\n0.3 set classifier.thresholds {p240=0.999}\n\
                0.5 set classifier.prior {smooth=0.25}\n";
    place.write("more.txt", more);
    let ran = place.done("log --sim own.toml --script more.txt --seconds 0.8");
    assert_eq!(ran.stdout.matches(": done").count(), 3, "{}", ran.stdout);
    let classes = "found \"felt\"; allowed: the model's classes, smooth";
    let costs = "decides by thresholds: write costs in their place in own.toml";
    for (set, why) in [
        ("classifier.prior={felt=0.5}", classes),
        ("classifier.prior={smooth=1.5}", "classifier.prior"),
        ("classifier.cost_error=3", costs),
    ] {
        place.refuses(&format!("set {set} --sim own.toml"), why);
    }
    let line = own.lines().find(|line| line.starts_with("threshold"));
    let costs = own.replace(line.unwrap(), "cost_error = 20\ncost_delay_per_s = 1");
    place.write("costs.toml", &costs);
    let ran = place.done("set classifier.cost_error=2000 --sim costs.toml");
    ran.prints("2000  differs");
    place.done("save classifier.prior={smooth=0.7,carpet=0.1} --scene own.toml");
    place.holds("own.toml", "prior = {smooth=0.7,carpet=0.1}");
}

const RESTART: &str = "it needs a restart: whisker deploy --scene";
const AT_START: &str =
    "the module is built from it at its start; it needs a restart: whisker deploy";

#[test]
fn what_cannot_be_set_is_refused_with_the_reason() {
    let place = Place::new();
    let part = "its part is not in the module's scene: add it to bench.toml, then whisker deploy";
    let noise = "noise: cannot change while the module runs; deploy the scene: whisker deploy";
    for (set, why) in [
        ("motor.kp=11", "found 11; allowed: a number from 0 to 10"),
        ("motor.min_deg=170", "allowed: below max_deg, which is 160"),
        ("motor.driver=six-step", AT_START),
        ("tick_hz=1000", AT_START),
        ("head.sides=both", RESTART),
        ("head.whiskers_per_side=2", RESTART),
        ("sensor.mode=slow", RESTART),
        ("telemetry.serial_baud=9600", RESTART),
        ("cia.gain=1", part),
        ("whisking.noise=0", noise),
        ("whisking.gain=1", "only the start uses it"),
        ("plant.stiffness=1", "it is of the simulated world"),
        ("motor.kq=1", "no key of a scene that can be set"),
        ("motor.kp", "allowed: KEY=VALUE"),
    ] {
        place.refuses(&format!("set {set} --sim bench.toml"), why);
    }
    let absent = "get motor.homing_duty --sim bench.toml";
    place.refuses(absent, "its part is not in the module's scene");
    place.write("s.txt", "0.1 set motor.gear 3\n");
    let script = "log --sim bench.toml --script s.txt";
    place.refuses(script, "motor.gear: angles are counted by it");
    place.write("s.txt", "0.1 set motor.kp 11\n");
    let ran = place.fails("log --sim bench.toml --script s.txt --seconds 0.3");
    ran.prints("found 11; allowed");
}

#[test]
fn a_module_of_another_version_of_the_scene_is_left_alone() {
    let place = Place::new();
    place.bench("newer.toml", &[("gain = 0.7", "gain = 0.8")]);
    let ran = place.done("get --sim bench.toml --scene newer.toml");
    let renews = "the module's scene bench is of another version than newer.toml, it differs in \
                  motion.whisking.rcp.gain; whisker deploy --scene newer.toml renews it";
    ran.prints(renews);
    assert_row(&ran, "rcp.gain 0.8 ?");
    let ran = place.fails("save rcp.gain --sim bench.toml --scene newer.toml");
    ran.warns(renews);
    let ran = place.fails("set motor.kp=0.06 --sim bench.toml --scene newer.toml");
    ran.warns(renews);
    place.bench("other.toml", &[OTHER]);
    let ran = place.run("get --sim bench.toml --scene other.toml");
    ran.warns("the module runs the scene bench, other.toml is of other");
    // World and seed are no other version.
    let ran = place.done("set motor.kp=0.06 --sim bench.toml --world bench.toml --seed 7");
    ran.prints("differs");
}

#[test]
fn keys_that_protect_are_set_while_the_motors_are_off() {
    let place = Place::new();
    let limits = "motor.following_limit_deg=31.5 motor.top_speed_deg_s=12000";
    let ran = place.fails(&format!("set {limits} --sim bench.toml"));
    let why = "changes only while no motor is armed; whisker stop switches them off";
    ran.warns(why);
    let scene = format!("{BENCH}[motor]\narm = \"on-command\"\n");
    place.write("off.toml", &scene);
    let ran = place.done(&format!("set {limits} --sim off.toml"));
    assert_eq!(ran.stdout.matches("differs").count(), 2, "{}", ran.stdout);
}

#[test]
fn more_keys_than_there_is_room_for_are_refused() {
    let place = Place::new();
    let keys = [
        "kp=0.0123456789",
        "kd=0.0000123456789",
        "slew_per_s=12345.6789012",
        "travel_margin_deg=12.3456789012",
        "following_limit_deg=23.4567890123",
        "continuous_duty=0.345678901234",
        "approach_deg_s=123.456789012",
    ];
    let set = keys.map(|key| format!("motor.{key}")).join(" ");
    let set = format!("set {set} --sim bench.toml");
    place.refuses(&set, "bytes, allowed: 192; whisker save --all");
}

#[test]
fn what_is_saved_is_the_scene_s_from_then_on() {
    let place = Place::new();
    let remarked = BENCH.replace("gain = 0.7", "gain = 0.7 # of the paper");
    place.write("bench.toml", &remarked);
    let dry = place.done("save motor.kp=0.08 rcp.gain=0.9 --scene bench.toml --dry-run");
    dry.prints("+kp = 0.08");
    dry.prints("-gain = 0.7 # of the paper");
    assert_eq!(place.text("bench.toml"), remarked);
    place.done("save motor.kp=0.08 rcp.gain=0.9 --scene bench.toml");
    let saved = remarked.replace("gain = 0.7 #", "gain = 0.9 #") + "\n[motor]\nkp = 0.08\n";
    assert_eq!(place.text("bench.toml"), saved);
    let ran = place.done("get motor.kp --sim bench.toml");
    ran.prints("0.08        0.08");

    let ran = place.done("save motor.kp=9 --scene bench.toml --dry-run");
    ran.warns("warning: no board takes it: motor.kp: found kp 9");
    place.refuses("save motor.kp=11 --scene bench.toml", "motor.kp: found 11");
    let ran = place.done("save --all --sim bench.toml");
    ran.prints("nothing to save");
    assert_eq!(place.text("bench.toml"), saved);
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("bench.toml", place.path("link.toml")).unwrap();
        place.refuses("save motor.kp=0.07 --scene link.toml", "is a symbolic link");
        assert_eq!(place.text("bench.toml"), saved);
    }
}

#[test]
fn the_page_names_all_keys() {
    let page = std::fs::read_to_string(scenes("../docs/calibrating.md")).unwrap();
    let (_, page) = page.split_once("### The keys").unwrap();
    let list = Place::new().done("get --list").stdout;
    let rows = list.lines().filter_map(|row| row.strip_prefix("| `"));
    let keys: Vec<&str> = rows.filter_map(|row| row.split('`').next()).collect();
    assert!(keys.len() > 20, "{list}");
    for key in keys {
        let named = format!("`{key}`");
        assert!(page.contains(&named), "docs/calibrating.md needs {key}");
    }
}

#[test]
#[ignore = "builds the program of another board; CI runs it"]
fn an_image_that_was_built_without_it_is_read_all_the_same() {
    let place = Place::new();
    let board = "--emulated @passive.toml --board nucleo-g071rb";
    let any_scene = "cargo xtask firmware --any-scene builds one that has it";
    for (command, without) in [
        ("set sensor.frozen_s=1", "settings by command"),
        ("deploy --scene @passive.toml", "deployment by command"),
    ] {
        let ran = place.fails(&format!("{command} {board}"));
        ran.warns(&format!("image was built without {without}; {any_scene}"));
    }
    let get = place.done(&format!("get {board}")).stdout;
    assert!(get.starts_with("the module runs scene passive ("), "{get}");
}

/// What no module takes is not written.
#[test]
fn whisking_that_the_motor_does_not_bear_is_not_saved() {
    let place = Place::new();
    let save = "save whisking.frequency_hz=25 --scene bench.toml";
    place.refuses(save, "bench.toml: whisking.frequency_hz: found 25");
}

/// Where home was found by another stop is nothing to hold it against.
#[test]
fn a_stop_that_is_set_is_that_of_the_next_homing() {
    let place = Place::new();
    let motor = "[motor]\narm = \"on-command\"\nrest = \"find\"\nstop_deg = 5.0\n";
    place.write("find.toml", &format!("{BENCH}{motor}"));
    let script = "0.1 arm\n4.0 stop\n4.2 set motor.stop_deg 8\n4.5 arm\n";
    place.write("s.txt", script);
    let ran = place.done("log --sim find.toml --script s.txt --seconds 7");
    ran.prints("set motor.stop_deg 8: done");
    assert!(!ran.stdout.contains("fault"), "{}", ran.stdout);
}
