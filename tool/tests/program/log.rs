//! `whisker log`.

use crate::common::{Place, textures};

#[test]
fn it_tells_touches_and_decisions_in_their_time() {
    let place = Place::new();
    let scene = textures();
    let ran = place.done(&format!("log --seconds 2.6 --sim {}", scene.display()));
    let lines: Vec<&str> = ran.stdout.lines().collect();
    let times = lines.iter().map(|line| {
        let (time, _) = line.split_once(' ').unwrap();
        time.parse::<f64>().unwrap()
    });
    let times: Vec<f64> = times.collect();
    assert!(times.is_sorted(), "{times:?}");
    assert!(
        times.iter().all(|t_s| (1.0..2.6).contains(t_s)),
        "{times:?}"
    );
    let has = |what: &str| lines.iter().filter(|line| line.contains(what)).count();
    // Whisking at 2 Hz, after a second in which touches are not reported yet.
    assert_eq!(has("INFO  end left "), 3, "{lines:?}");
    assert!(has("INFO  decision left smooth 99.") >= 3, "{lines:?}");
}

#[test]
fn where_nothing_is_logged_it_says_why() {
    let place = Place::new();
    let still = crate::common::BENCH.replace("[100.0]", "[140.0]");
    place.write("still.toml", &still);
    let ran = place.done("log --sim still.toml --seconds 0.5");
    assert_eq!(ran.stdout, "");
    assert!(ran.stderr.contains("nothing was logged"), "{}", ran.stderr);
}

#[test]
fn it_needs_one_module() {
    let place = Place::new();
    assert!(place.refused("log").contains("--sim <SCENE>"));
    assert!(
        place
            .refused("log --sim bench.toml --emulated bench.toml")
            .contains("cannot be used")
    );
    assert!(place.refused("log --sim none.toml").contains("none.toml"));
    assert!(
        place
            .refused("log --sim bench.toml --seconds 0")
            .contains("above 0")
    );
    assert!(
        place
            .refused("log --sim bench.toml --program x.elf")
            .contains("--emulated")
    );
    let two = crate::common::BENCH.replace("side = 1", "side = 2");
    place.write("two.toml", &two);
    assert!(
        place
            .refused("log --sim two.toml")
            .contains("head.whiskers_per_side = 1")
    );
}
