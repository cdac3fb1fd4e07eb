//! `whisker set`, `get` and `save`.

use std::path::Path;

use crate::common::{BENCH, Place, scenes};

/// The rows of a table from a time on.
fn rows_from(table: &str, from_s: f64) -> Vec<&str> {
    let rows = table
        .lines()
        .filter(|row| row.starts_with(|c: char| c.is_ascii_digit()));
    let is_later = |row: &&str| {
        let t_s: f64 = row.split(',').nth(1).unwrap().parse().unwrap();
        t_s > from_s
    };
    rows.filter(is_later).collect()
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
        let ran = place.done(&format!(
            "records --sim {scene}.toml --script {script}.txt --seconds 2 --out r.csv"
        ));
        (ran.stdout, place.text("r.csv"))
    };
    let (_, expected) = table("new", "arm");
    let (said, found) = table("old", "set");
    assert!(said.contains("set motor.kp 0.08: done"), "{said}");
    let (_, untouched) = table("old", "arm");
    let later = |table| rows_from(table, 0.45);
    assert_eq!(later(&expected).len(), 3_100);
    assert!(later(&found) == later(&expected));
    assert!(later(&found) != later(&untouched));
}

#[test]
fn it_says_what_differs() {
    let place = Place::new();
    let ran = place.done("set motor.kp=0.08 rcp.tau_s=0.2 --sim bench.toml");
    let lines: Vec<Vec<&str>> = ran
        .stdout
        .lines()
        .map(|line| line.split_whitespace().collect())
        .collect();
    assert_eq!(lines[1][..4], ["motor.kp", "0.05", "0.08", "differs"]);
    assert_eq!(lines[2][..4], ["rcp.tau_s", "0.125", "0.2", "differs"]);
    let ran = place.done("get --sim bench.toml");
    assert!(!ran.stdout.contains("differs"), "{}", ran.stdout);
    assert!(
        ran.stdout.contains("motor.approach_deg_s"),
        "{}",
        ran.stdout
    );
    // Its scene has no part for these.
    for absent in ["cia.gain", "classifier.threshold", "motor.homing_duty"] {
        assert!(!ran.stdout.contains(absent), "{}", ran.stdout);
    }
}

#[test]
fn what_cannot_be_set_is_refused_with_the_reason() {
    let place = Place::new();
    for (set, why) in [
        (
            "motor.kp=11",
            "motor.kp: found 11; allowed: a number from 0 to 10",
        ),
        ("motor.min_deg=170", "allowed: below max_deg, which is 160"),
        (
            "motor.driver=six-step",
            "the module is built from it at its start; it needs a restart",
        ),
        (
            "cia.gain=1",
            "cia.gain: its part is not in the module's scene: add it to bench.toml, then whisker deploy",
        ),
        (
            "whisking.noise=0",
            "whisking.noise: noise: cannot change while the module runs; deploy the scene: whisker deploy",
        ),
        (
            "tick_hz=1000",
            "tick_hz: the module is built from it at its start; it needs a restart: whisker deploy",
        ),
        (
            "head.sides=both",
            "it needs a restart: whisker deploy --scene",
        ),
        (
            "head.whiskers_per_side=2",
            "it needs a restart: whisker deploy --scene",
        ),
        (
            "sensor.mode=slow",
            "it needs a restart: whisker deploy --scene",
        ),
        (
            "telemetry.serial_baud=9600",
            "it needs a restart: whisker deploy --scene",
        ),
        ("whisking.gain=1", "only the start uses it"),
        ("plant.stiffness=1", "it is of the simulated world"),
        ("motor.kq=1", "no key of a scene that can be set"),
        ("motor.kp", "allowed: KEY=VALUE"),
    ] {
        let said = place.refused(&format!("set {set} --sim bench.toml"));
        assert!(said.contains(why), "{set}: {said}");
    }
    let said = place.refused("get motor.homing_duty --sim bench.toml");
    assert!(
        said.contains("its part is not in the module's scene"),
        "{said}"
    );
    place.write("s.txt", "0.1 set motor.gear 3\n");
    let said = place.refused("log --sim bench.toml --script s.txt");
    assert!(
        said.contains("motor.gear: angles are counted by it"),
        "{said}"
    );
    place.write("s.txt", "0.1 set motor.kp 11\n");
    let ran = place.run("log --sim bench.toml --script s.txt --seconds 0.3");
    assert_eq!(ran.status, Some(1));
    assert!(ran.stdout.contains("found 11; allowed"), "{}", ran.stdout);
}

#[test]
fn a_module_of_another_version_of_the_scene_is_left_alone() {
    let place = Place::new();
    place.write("newer.toml", &BENCH.replace("gain = 0.7", "gain = 0.8"));
    let ran = place.done("get --sim bench.toml --scene newer.toml");
    let renews = "the module's scene bench is of another version than newer.toml, it differs in \
                  motion.whisking.rcp.gain; whisker deploy --scene newer.toml renews it";
    assert!(ran.stdout.contains(renews), "{}", ran.stdout);
    let ran = place.run("set motor.kp=0.06 --sim bench.toml --scene newer.toml");
    assert_eq!(ran.status, Some(1));
    assert!(ran.stderr.contains(renews), "{}", ran.stderr);
    place.write("other.toml", &BENCH.replace("\"bench\"", "\"other\""));
    let ran = place.run("get --sim bench.toml --scene other.toml");
    let runs = "the module runs the scene bench, other.toml is of other";
    assert!(ran.stderr.contains(runs), "{}", ran.stderr);
    // World and seed are no other version.
    let ran = place.done("set motor.kp=0.06 --sim bench.toml --world bench.toml --seed 7");
    assert!(ran.stdout.contains("differs"), "{}", ran.stdout);
}

#[test]
fn keys_that_protect_are_set_while_the_motors_are_off() {
    let place = Place::new();
    let limits = "motor.following_limit_deg=31.5 motor.top_speed_deg_s=12000";
    let ran = place.run(&format!("set {limits} --sim bench.toml"));
    assert_eq!(ran.status, Some(1));
    let why = "changes only while no motor is armed; whisker stop switches them off";
    assert!(ran.stderr.contains(why), "{}", ran.stderr);
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
    let said = place.refused(&format!("set {set} --sim bench.toml"));
    assert!(
        said.contains("bytes, allowed: 192; whisker save --all"),
        "{said}"
    );
}

#[test]
fn what_is_saved_is_the_scene_s_from_then_on() {
    let place = Place::new();
    let remarked = BENCH.replace("gain = 0.7", "gain = 0.7 # of the paper");
    place.write("bench.toml", &remarked);
    let dry = place.done("save motor.kp=0.08 rcp.gain=0.9 --scene bench.toml --dry-run");
    assert!(dry.stdout.contains("+kp = 0.08"), "{}", dry.stdout);
    assert!(
        dry.stdout.contains("-gain = 0.7 # of the paper"),
        "{}",
        dry.stdout
    );
    assert_eq!(place.text("bench.toml"), remarked);
    place.done("save motor.kp=0.08 rcp.gain=0.9 --scene bench.toml");
    let saved = remarked.replace("gain = 0.7 #", "gain = 0.9 #") + "\n[motor]\nkp = 0.08\n";
    assert_eq!(place.text("bench.toml"), saved);
    let ran = place.done("get motor.kp --sim bench.toml");
    assert!(ran.stdout.contains("0.08        0.08"), "{}", ran.stdout);

    let said = place.refused("save motor.kp=11 --scene bench.toml");
    assert!(said.contains("motor.kp: found 11"), "{said}");
    let ran = place.done("save --all --sim bench.toml");
    assert!(ran.stdout.contains("nothing to save"), "{}", ran.stdout);
    assert_eq!(place.text("bench.toml"), saved);
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("bench.toml", place.path("link.toml")).unwrap();
        let said = place.refused("save motor.kp=0.07 --scene link.toml");
        assert!(said.contains("is a symbolic link"), "{said}");
        assert_eq!(place.text("bench.toml"), saved);
    }
}

#[test]
fn the_page_names_all_keys() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/calibrating.md");
    let page = std::fs::read_to_string(page).unwrap();
    let (_, page) = page.split_once("### The keys").unwrap();
    let list = Place::new().done("get --list").stdout;
    let rows = list.lines().filter_map(|row| row.strip_prefix("| "));
    let keys: Vec<&str> = rows.filter(|row| row.starts_with('`')).collect();
    assert!(keys.len() > 20, "{list}");
    for row in keys {
        let (key, _) = row.split_once(' ').unwrap();
        assert!(page.contains(key), "docs/calibrating.md needs {key}");
    }
}

#[test]
fn an_image_that_was_built_without_it_is_read_all_the_same() {
    let place = Place::new();
    let scene = scenes("passive.toml");
    let board = format!("--emulated {} --board nucleo-g071rb", scene.display());
    let any_scene = "cargo xtask firmware --any-scene builds one that has it";
    for (command, without) in [
        ("set sensor.frozen_s=1", "settings by command"),
        (
            &*format!("deploy --scene {}", scene.display()),
            "deployment by command",
        ),
    ] {
        let ran = place.run(&format!("{command} {board}"));
        assert_eq!(ran.status, Some(1), "{}", ran.stdout);
        let says = format!("the module's image was built without {without}; {any_scene}");
        assert!(ran.stderr.contains(&says), "{}", ran.stderr);
    }
    let get = place.done(&format!("get {board}")).stdout;
    assert!(get.starts_with("the module runs scene passive ("), "{get}");
}
