//! Faulty scenes whose keys do not go together, and files with many problems.

use crate::common::{FULL, complaint, refuses, with};

const PASSIVE: &str = "name = 'a'\ntick_hz = 2000\nduration_s = 1\nseed = 0\n\
                       head.whiskers_per_side = 1\n";

#[test]
fn missing_keys_and_tables() {
    refuses(
        "noise        = 0.0\n",
        "",
        "s.toml:9: whisking.noise: missing; required: a number from 0 to 1",
    );
    refuses(
        "seed        = 1 ",
        "",
        "s.toml:1: seed: missing; required: a whole number from 0 to 9223372036854775807",
    );
    assert_eq!(
        complaint(PASSIVE),
        "s.toml:1: [plant]: missing; required: a table with the keys \
         kind, obstacle_deg, stiffness, textures, present_s, shaft, length_m, hub_diameter_m, \
         tip_diameter_m, youngs_pa, density_kg_m3, damping_ratio, follicle_n_m_rad"
    );
    let all = "s.toml:1: name: missing\ns.toml:1: tick_hz: missing\ns.toml:1: duration_s: missing\n\
               s.toml:1: seed: missing\ns.toml:1: [head]: missing\ns.toml:1: [plant]: missing";
    let complaint = complaint("");
    let starts: Vec<&str> = complaint
        .lines()
        .filter_map(|line| line.split(';').next())
        .collect();
    assert_eq!(starts.join("\n"), all);
}

#[test]
fn gates_and_motor_need_whisking() {
    for section in ["rcp", "cia", "motor"] {
        let keys = if section == "motor" {
            ""
        } else {
            "gain = 1\ntau_s = 1\n"
        };
        let text = format!("{PASSIVE}plant.kind = 'ideal'\n[{section}]\n{keys}");
        assert_eq!(
            complaint(&text),
            format!(
                "s.toml:7: [{section}]: found without [whisking]; [{section}] acts on whisking: \
                 add [whisking], or leave [{section}] out"
            )
        );
    }
}

#[test]
fn rules_need_their_key() {
    refuses(
        "threshold = 0.99\n",
        "",
        "s.toml:30: classifier.threshold: missing; \
         required because rule = \"sequential\": a number above 0 and below 1",
    );
    let window = with(FULL, "\"sequential\" ", "\"window\" ");
    assert_eq!(
        complaint(&with(&window, "window    = 400\n", "")),
        "s.toml:30: classifier.window: missing; \
         required because rule = \"window\": a whole number from 1 to 1000000, in samples"
    );
}

#[test]
fn lists_fit_the_head() {
    refuses(
        "gain         = 1.0",
        "gain = [1, 1, 1]",
        "s.toml:14: whisking.gain: found 3 entries; \
         allowed: exactly 2 entries, as the head has 2 sides of 1",
    );
    refuses(
        "[[1.0, 0.0], [1.0, 0.0]]",
        "[[1.0, 0.0]]",
        "s.toml:15: whisking.start: found 1 entry; \
         allowed: exactly 2 entries, as the head has 2 sides",
    );
    refuses(
        "[100.0, 125.0]",
        "[]",
        "s.toml:27: plant.obstacle_deg: found 0 entries; \
         allowed: exactly 2 entries, as the head has 2 sides",
    );
    let left = with(FULL, "[whisking]", "sides = 'left'\n[whisking]");
    assert_eq!(
        complaint(&left),
        "s.toml:16: whisking.start: found 2 entries; \
         allowed: exactly 1 entry, as the head has 1 side\n\
         s.toml:28: plant.obstacle_deg: found 2 entries; \
         allowed: exactly 1 entry, as the head has 1 side"
    );
}

#[test]
fn entries_of_lists_are_named_where_they_stand() {
    refuses(
        "gain         = 1.0",
        "gain = [\n  1,\n  3,\n  'x',\n]",
        "s.toml:16: whisking.gain: found 3 as entry 2; \
         allowed: a number from 0 to 2, or a list of such, one a whisker, left side first\n\
         s.toml:17: whisking.gain: found 'x' as entry 3; \
         allowed: a number from 0 to 2, or a list of such, one a whisker, left side first",
    );
    refuses(
        "[[1.0, 0.0], [1.0, 0.0]]",
        "[[1, 0], [1, 0, 0]]",
        "s.toml:15: whisking.start: found [1, 0, 0] as entry 2; \
         allowed: a list of pairs of numbers from -1.5 to 1.5, one pair a side, left first",
    );
}

#[test]
fn obstacles_need_stiffness() {
    refuses(
        "stiffness = 0.1\n",
        "",
        "s.toml:25: plant.stiffness: missing; \
         required because obstacle_deg is given: a number from 0 to 100, in 1/degree",
    );
}

#[test]
fn textures_and_their_plant() {
    refuses(
        "stiffness = 0.1",
        "stiffness = 0.1\ntextures = ['smooth']\npresent_s = 1",
        "s.toml:29: plant.textures: found, but not used here; \
         allowed only where kind = \"textured\" or kind = \"whisker\"\n\
         s.toml:30: plant.present_s: found, but not used here; \
         allowed only where kind = \"textured\" or kind = \"whisker\"",
    );
    refuses(
        "kind      = \"ideal\"\nobstacle_deg = [100.0, 125.0]   # left, right\nstiffness = 0.1",
        "kind = 'textured'",
        "s.toml:25: plant.obstacle_deg: missing; required because kind = \"textured\": \
         a list of numbers from -360 to 360, one a side, left first, in degrees\n\
         s.toml:25: plant.stiffness: missing; required because kind = \"textured\": \
         a number from 0 to 100, in 1/degree\n\
         s.toml:25: plant.textures: missing; required because kind = \"textured\": \
         a list of at least one of \"smooth\" or \"p600\" or \"p240\" or \"carpet\", \
         each at most once\n\
         s.toml:25: plant.present_s: missing; required because kind = \"textured\": \
         a number above 0 and at most 100000, in s",
    );
    let words = "allowed: a list of at least one of \"smooth\" or \"p600\" or \"p240\" or \
                 \"carpet\", each at most once";
    for (list, found) in [
        ("[]", "found []; "),
        ("['p240', 'p240']", "found 'p240' again as entry 2; "),
        (
            "['p240', 'capret']",
            "found 'capret' as entry 2; did you mean \"carpet\"? ",
        ),
    ] {
        let kind = format!("kind = 'textured'\npresent_s = 1\ntextures = {list}");
        let expected = format!("s.toml:28: plant.textures: {found}{words}");
        refuses("kind      = \"ideal\"", &kind, &expected);
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
fn shafts_and_their_plant() {
    let whisker = "kind = 'whisker'\ntextures = ['p600']\npresent_s = 1\n";
    refuses(
        "kind      = \"ideal\"",
        "kind = 'ideal'\nshaft = 'floor-robot'",
        "s.toml:27: plant.shaft: found, but not used here; \
         allowed only where kind = \"whisker\"",
    );
    refuses(
        "kind      = \"ideal\"",
        &format!("{whisker}length_m = 0.1"),
        "s.toml:29: plant.length_m: found, but not used here; \
         allowed only where shaft = \"own\"",
    );
    let numbers = "shaft = 'own'\nlength_m = 0.1\nhub_diameter_m = 0.021\n\
                   tip_diameter_m = 0.02\nyoungs_pa = 1e9\ndensity_kg_m3 = 1000\ndamping_ratio = 0.1";
    refuses(
        "kind      = \"ideal\"",
        &format!("{whisker}{numbers}"),
        "s.toml:25: plant.follicle_n_m_rad: missing; required because shaft = \"own\": \
         a number from 0.000000001 to 1000000, in N m/rad\n\
         s.toml:31: plant.hub_diameter_m: found 0.021; \
         allowed: at most a fifth of length_m, which is 0.1",
    );
}

#[test]
fn limits_of_the_setpoint_are_in_order() {
    let motor = |keys: &str| format!("[motor]\n{keys}\n\n[plant]\n");
    refuses(
        "[plant]\n",
        &motor("max_deg = 50\nmin_deg = 50"),
        "s.toml:27: motor.min_deg: found 50; allowed: below max_deg, which is 50",
    );
    // Against the defaults, 30 and 160.
    refuses(
        "[plant]\n",
        &motor("min_deg = 170"),
        "s.toml:26: motor.min_deg: found 170; allowed: below max_deg, which is 160",
    );
    refuses(
        "[plant]\n",
        &motor("max_deg = 20"),
        "s.toml:26: motor.max_deg: found 20; allowed: above min_deg, which is 30",
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
    let seen: Vec<(Option<usize>, &str)> = problems
        .as_slice()
        .iter()
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
