//! Faulty scenes without the whisking that their keys need, and files with many problems.

use crate::common::{FULL, complaint, with};

const PASSIVE: &str = "name = 'a'\ntick_hz = 2000\nduration_s = 1\nseed = 0\n\
                       head.whiskers_per_side = 1\n";

#[test]
fn missing_keys_and_tables() {
    assert_eq!(
        complaint(&PASSIVE.replace("head.whiskers_per_side = 1\n", "")),
        "s.toml:1: [head]: missing; required: a table with the keys whiskers_per_side, rows, sides, \
         nodes, bus_kbit_s"
    );
    let all = "s.toml:1: name: missing\ns.toml:1: tick_hz: missing\ns.toml:1: duration_s: missing\n\
               s.toml:1: seed: missing\ns.toml:1: [head]: missing";
    let complaint = complaint("");
    let lines = complaint.lines();
    let starts: Vec<&str> = lines.filter_map(|line| line.split(';').next()).collect();
    assert_eq!(starts.join("\n"), all);
}

#[test]
fn self_motion_gates_and_motor_need_whisking() {
    let says = |part| {
        format!(
            "s.toml:6: sensor.self_motion_s: found without [{part}]; allowed: only with [{part}]"
        )
    };
    let text = format!("{PASSIVE}sensor.self_motion_s = 2\nplant.kind = 'ideal'\n");
    let expected = ["whisking", "classifier"].map(says).join("\n");
    assert_eq!(complaint(&text), expected);
    let gate = "gain = 1\ntau_s = 1\n";
    for (section, keys) in [("rcp", gate), ("cia", gate), ("motor", "")] {
        let text = format!("{PASSIVE}plant.kind = 'ideal'\n[{section}]\n{keys}");
        let expected = format!(
            "s.toml:7: [{section}]: found without [whisking]; [{section}] acts on whisking: \
             add [whisking], or leave [{section}] out"
        );
        assert_eq!(complaint(&text), expected);
    }
}

#[test]
fn the_textured_plant_needs_an_active_whisker() {
    let text = format!(
        "{PASSIVE}[plant]\nkind = 'textured'\nobstacle_deg = [1, 1]\nstiffness = 1\n\
         textures = ['p600']\npresent_s = 0.0001\n"
    );
    assert_eq!(
        complaint(&text),
        "s.toml:7: plant.kind: found \"textured\" without [whisking]; the textured plant needs \
         an active whisker: add [whisking], or choose \"ideal\"\n\
         s.toml:11: plant.present_s: found 0.0001 s; \
         allowed: at least one tick, that is 1/2000 s"
    );
}

#[test]
fn all_problems_are_listed_in_file_order() {
    let text = with(FULL, "name        = \"rcp7\"", "name = 'a b'");
    let text = with(&text, "duration_s  = 6.0", "duration = 0");
    let text = with(&text, "frequency_hz = 2.0", "frequncy_hz = 200");
    let text = with(&text, "noise        = 0.0", "noise = -1");
    let text = with(&text, "[cia]", "[cio]");
    let text = with(&text, "kind      = \"ideal\"", "kind = 3");
    let text = with(&text, "threshold = 0.99\n", "");
    let problems = scene::Scene::from_str("s.toml", &text).expect_err("all is wrong");
    let all = problems.as_slice().iter();
    let seen: Vec<_> = all
        .map(|problem| (problem.line, problem.key.as_str()))
        .collect();
    let expected = [
        (1, "name"),
        (3, "duration"),
        (3, "duration_s"),
        (10, "whisking.frequncy_hz"),
        (10, "whisking.frequency_hz"),
        (13, "whisking.noise"),
        (21, "cio"),
        (26, "plant.kind"),
        (30, "classifier.threshold"),
    ];
    assert_eq!(seen, expected.map(|(line, key)| (Some(line), key)));
    assert_eq!(problems.to_string().lines().count(), expected.len());
}

#[test]
fn several_decide_only_where_they_can() {
    let all = |whiskers: &str| {
        let keys = format!("window    = 400\nwhiskers = \"{whiskers}\"\n");
        with(FULL, "window    = 400\n", &keys)
    };
    let window = |whiskers| with(&all(whiskers), "= \"sequential\"    #", "= \"window\"    #");
    let alone = |whiskers| {
        let text = with(&all(whiskers), "[whisking]", "sides = 'left'\n[whisking]");
        let text = with(&text, "[[1.0, 0.0], [1.0, 0.0]]", "[[1.0, 0.0]]");
        with(&text, "[100.0, 125.0]", "[100.0]")
    };
    let two = with(
        &alone("each"),
        "whiskers_per_side = 1 ",
        "whiskers_per_side = 2 ",
    );
    let several = ["first", "each", "together"].map(all);
    for text in several.iter().chain(&[window("each"), alone("first"), two]) {
        assert_eq!(complaint(text), "");
    }
    assert_eq!(
        complaint(&window("together")),
        "s.toml:35: classifier.whiskers: found \"together\"; allowed: \"first\" or \"each\", as a \
         window counts the samples of one whisker"
    );
    for whiskers in ["each", "together"] {
        let expected = format!(
            "s.toml:36: classifier.whiskers: found \"{whiskers}\"; allowed: \"first\", as there is \
             one whisker"
        );
        assert_eq!(complaint(&alone(whiskers)), expected);
    }
}

#[test]
fn boards_of_a_head_share_alike() {
    let head = |whiskers: usize, keys: &str| {
        let keys = format!("head.whiskers_per_side = {whiskers}\n{keys}");
        complaint(&PASSIVE.replace("head.whiskers_per_side = 1\n", &keys))
    };
    for nodes in [2, 3, 4, 6, 12] {
        assert_eq!(head(6, &format!("head.nodes = {nodes}\n")), "");
    }
    assert!(head(6, "head.nodes = 5\n").contains(
        "head.nodes: found 5 boards for 12 whiskers; allowed: a number that divides that of the \
         whiskers"
    ));
    assert_eq!(head(6, "head.rows = 2\n"), "");
    assert!(head(6, "head.rows = 4\n").contains(
        "head.rows: found 4 rows for 6 whiskers a side; allowed: a number that divides that of the \
         whiskers"
    ));
    assert!(head(6, "head.nodes = 1\n").contains("head.nodes: found 1; allowed: "));
    assert!(head(6, "head.bus_kbit_s = 500\n").contains("head.bus_kbit_s: found"));
    assert!(head(6, "head.nodes = 2\nhead.bus_kbit_s = 50\n").contains("125 to 1000"));
}
