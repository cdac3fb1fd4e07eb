//! `whisker log`.

use crate::common::Place;

#[test]
fn where_nothing_is_logged_it_says_why() {
    let place = Place::new();
    place.bench("still.toml", &[("[100.0]", "[140.0]")]);
    let ran = place.done("log --sim still.toml --seconds 0.5");
    assert_eq!(ran.stdout, "");
    ran.warns("nothing was logged");
}

#[test]
fn it_needs_one_module() {
    let place = Place::new();
    place.bench("two.toml", &[("side = 1", "side = 2")]);
    place.write("text.elf", "no program");
    for (options, why) in [
        ("", "--sim <SCENE>"),
        ("--sim bench.toml --emulated bench.toml", "cannot be used"),
        ("--sim none.toml", "none.toml"),
        ("--sim bench.toml --seconds 0", "above 0"),
        ("--sim bench.toml --program x.elf", "--emulated"),
        ("--emulated bench.toml --program none.elf", "none.elf: "),
        ("--emulated bench.toml --program text.elf", "text.elf: "),
        ("--sim two.toml", "head.whiskers_per_side = 1"),
    ] {
        place.refuses(&format!("log {options}"), why);
    }
}
