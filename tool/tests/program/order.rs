//! One command to a module, and `whisker doctor` and `flash` where there is no board.

use crate::common::Place;

#[test]
fn a_command_is_carried_out_and_its_tick_printed() {
    let place = Place::new();
    for (command, says) in [
        ("arm", "armed, after tick "),
        ("stop", "motors off until armed, after tick "),
        ("clear left", "faults cleared, after tick "),
    ] {
        let ran = place.done(&format!("{command} --sim bench.toml"));
        assert!(ran.stdout.starts_with(says), "{command}: {}", ran.stdout);
        assert_eq!(ran.stderr, "");
    }
}

#[test]
fn what_a_module_has_not_is_refused() {
    let place = Place::new();
    for (command, says) in [
        ("clear right", "no such whisker"),
        ("home left", "not in this program"),
    ] {
        let ran = place.fails(&format!("{command} --sim bench.toml"));
        assert_eq!(ran.stdout, "");
        ran.warns(says);
    }
    place.refuses("clear --sim bench.toml", "<SIDE>");
    place.refuses("clear front --sim bench.toml", "left");
    place.refuses("arm", "--probe");
}

#[test]
fn the_status_is_what_the_module_says_of_itself() {
    let place = Place::new();
    place.bench("slow.toml", &[("hz = 2000", "hz = 1000")]);
    let ran = place.done("status --sim slow.toml");
    ran.prints("scene bench\n1000 ticks a second, whiskers: 1\n");
    ran.prints(" ticks since the start, 0 missed\n0 records found no room\n");
}

/// No probe has that serial number, whatever is plugged in here.
#[test]
fn without_its_board_nothing_is_built_or_flashed() {
    let place = Place::new();
    let ran = place.run("flash bench.toml --probe none");
    let without = !cfg!(feature = "probe");
    assert_eq!(ran.status, Some(if without { 2 } else { 1 }));
    let says = ["probe", "built without probes"][usize::from(without)];
    ran.warns(says);
    assert!(!ran.stderr.contains("building"), "{}", ran.stderr);
    place.run("status --probe none").warns(says);
    place.refuses("flash bench.toml --program x.elf", "x.elf: ");
}

#[test]
fn the_doctor_fails_where_something_needed_is_missing() {
    let place = Place::new();
    let ran = place.run("doctor --for sim");
    let is_missing = |line: &str| line.starts_with("missing  ");
    let missing = ran.stdout.lines().any(is_missing);
    assert_eq!(ran.status, Some(i32::from(missing)), "{}", ran.stdout);
    assert_eq!(ran.stderr.is_empty(), !missing, "{}", ran.stderr);
    // What a board needs is listed, but not required.
    let of_boards = |line: &&str| line.contains("debug probe") && !line.starts_with("ok ");
    let mut of_boards = ran.stdout.lines().filter(of_boards);
    assert!(of_boards.all(|line| line.starts_with("absent ")));
}
