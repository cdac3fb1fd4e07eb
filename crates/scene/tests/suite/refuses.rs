//! Faulty scenes, and what is said of them: problems of one key at a time.

use crate::common::{FULL, complaint, refuses, with};
use scene::Scene;

#[test]
fn numbers_out_of_range() {
    refuses(
        "frequency_hz = 2.0",
        "frequency_hz = 25.1",
        "s.toml:10: whisking.frequency_hz: found 25.1; allowed: a number from 0.05 to 25, in Hz",
    );
    refuses(
        "tick_hz     = 2000",
        "tick_hz = 199",
        "s.toml:2: tick_hz: found 199; allowed: a whole number from 200 to 20000, in Hz",
    );
    refuses(
        "threshold = 0.99",
        "threshold = 1.0",
        "s.toml:33: classifier.threshold: found 1.0; allowed: a number above 0 and below 1",
    );
    refuses(
        "seed        = 1 ",
        "seed = -1 ",
        "s.toml:4: seed: found -1; allowed: a whole number from 0 to 9223372036854775807",
    );
    refuses(
        "stiffness = 0.1",
        "stiffness = nan",
        "s.toml:28: plant.stiffness: found nan; allowed: a number from 0 to 100, in 1/degree",
    );
}

/// The edge of every numeric range: the first value is in, the second is out.
#[test]
fn edges_of_ranges() {
    let cases = [
        ("tick_hz     = 2000", "tick_hz = ", "200", "199"),
        ("tick_hz     = 2000", "tick_hz = ", "20000", "20001"),
        ("duration_s  = 6.0", "duration_s = ", "1e5", "100000.1"),
        ("duration_s  = 6.0", "duration_s = ", "0.0005", "0.0"),
        ("duration_s  = 6.0", "duration_s = ", "0.0005", "0.0004"),
        ("seed        = 1 ", "seed = ", "0", "-1"),
        (
            "seed        = 1 ",
            "seed = ",
            "9223372036854775807",
            "9223372036854775808",
        ),
        ("whiskers_per_side = 1 ", "whiskers_per_side = ", "12", "13"),
        ("whiskers_per_side = 1 ", "whiskers_per_side = ", "1", "0"),
        ("frequency_hz = 2.0", "frequency_hz = ", "0.05", "0.049"),
        ("frequency_hz = 2.0", "frequency_hz = ", "25", "26"),
        ("noise        = 0.0", "noise = ", "1", "1.01"),
        ("noise        = 0.0", "noise = ", "-0.0", "-0.01"),
        ("gain         = 1.0", "gain = ", "2", "2.01"),
        ("gain         = 1.0", "gain = ", "[0, 2]", "[0, 2.01]"),
        ("gain         = 1.0", "gain = ", "0", "inf"),
        (
            "[[1.0, 0.0], [1.0, 0.0]]",
            "",
            "[[1.5, 0], [0, -1.5]]",
            "[[1.51, 0], [0, 0]]",
        ),
        (
            "[[1.0, 0.0], [1.0, 0.0]]",
            "",
            "[[1.5, 0], [0, -1.5]]",
            "[[0, 0], [0, -1.51]]",
        ),
        ("gain  = 0.7", "gain = ", "100", "100.1"),
        ("gain  = 0.5", "gain = ", "0", "-1e-9"),
        (
            "gain  = 0.7\ntau_s = 0.125",
            "gain = 1\ntau_s = ",
            "1e-6",
            "9e-7",
        ),
        (
            "gain  = 0.5\ntau_s = 0.125",
            "gain = 1\ntau_s = ",
            "1e5",
            "1e6",
        ),
        ("[100.0, 125.0]", "", "[-360, 360]", "[-361, 360]"),
        ("[100.0, 125.0]", "", "[-360, 360]", "[-360, 1e400]"),
        ("stiffness = 0.1", "stiffness = ", "0", "-0.1"),
        ("stiffness = 0.1", "stiffness = ", "100", "101"),
        ("threshold = 0.99", "threshold = ", "0.000001", "0"),
        ("window    = 400", "window = ", "1", "0"),
        ("window    = 400", "window = ", "1000000", "1000001"),
        ("window    = 400", "contact_min = ", "0", "-0.1"),
        ("window    = 400", "contact_min = ", "1", "1.1"),
        ("[plant]\n", "[plant]\n[motor]\nkp = ", "10", "11"),
        ("[plant]\n", "[motor]\nkd = ", "1", "1.1"),
        ("[plant]\n", "[motor]\nduty_limit = ", "0", "-0.1"),
        ("[plant]\n", "[motor]\nduty_limit = ", "1", "1.1"),
        ("[plant]\n", "[motor]\nslew_per_s = ", "1e5", "0"),
        ("[plant]\n", "[motor]\nmin_deg = ", "-360", "-361"),
        ("[plant]\n", "[motor]\nmax_deg = ", "360", "361"),
        ("[plant]\n", "[motor]\ngear = ", "1", "0.9"),
        ("[plant]\n", "[motor]\ngear = ", "1000", "1001"),
        ("[plant]\n", "[motor]\ncounts_per_rev = ", "4", "3"),
        ("[plant]\n", "[motor]\ncounts_per_rev = ", "65536", "65537"),
    ];
    for (old, key, inside, outside) in cases {
        // A motor table goes in front of the plant; all else stays in its place.
        let key = key.trim_start_matches("[plant]\n");
        let tail = if old == "[plant]\n" {
            "\n[plant]\n"
        } else {
            "\n"
        };
        let text = |value: &str| with(FULL, old, &format!("{key}{value}{tail}"));
        assert_eq!(complaint(&text(inside)), "", "{key}{inside}");
        let complaint = complaint(&text(outside));
        assert_eq!(
            complaint.lines().count(),
            1,
            "{key}{outside}: {complaint:?}"
        );
        assert!(
            complaint.contains("; allowed: "),
            "{key}{outside}: {complaint:?}"
        );
    }
}

#[test]
fn values_of_another_type() {
    refuses(
        "coupling     = true",
        "coupling = 1",
        "s.toml:12: whisking.coupling: found 1; allowed: true or false",
    );
    refuses(
        "whiskers_per_side = 1 ",
        "whiskers_per_side = 1.0 ",
        "s.toml:7: head.whiskers_per_side: found 1.0; allowed: a whole number from 1 to 12",
    );
    refuses(
        "tau_s = 0.125\n\n[cia]",
        "tau_s = '0.125'\n\n[cia]",
        "s.toml:19: rcp.tau_s: found '0.125'; allowed: a number from 0.000001 to 100000, in s",
    );
    refuses(
        "\"models/example.model\"",
        "''",
        "s.toml:32: classifier.model: found ''; allowed: a path",
    );
    refuses(
        "[rcp]\ngain  = 0.7\ntau_s = 0.125",
        "[[rcp]]\ngain  = 0.7\ntau_s = 0.125",
        "s.toml:17: [rcp]: found [[rcp]]; allowed: a table of keys under the header [rcp]",
    );
}

#[test]
fn words_are_suggested() {
    refuses(
        "integrator   = \"exact\"",
        "integrator = \"exakt\"",
        "s.toml:11: whisking.integrator: found \"exakt\"; \
         did you mean \"exact\"? allowed: \"exact\" or \"euler\"",
    );
    refuses(
        "kind      = \"ideal\"",
        "kind = 'physics'",
        "s.toml:26: plant.kind: found 'physics'; allowed: \"ideal\" or \"textured\" or \"whisker\"",
    );
}

#[test]
fn names_must_suit_file_names() {
    let allowed = "allowed: 1 to 64 of the letters A-Z and a-z, the digits, '-', '_' and '.', \
                   not dots alone";
    for bad in ["", "a/b", "..", "a b", "ä", &"x".repeat(65)] {
        let text = with(FULL, "\"rcp7\"", &format!("{bad:?}"));
        let complaint = complaint(&text);
        assert!(
            complaint.starts_with("s.toml:1: name: found \""),
            "{complaint}"
        );
        assert!(complaint.ends_with(allowed), "{complaint}");
    }
    assert_eq!(complaint(&with(FULL, "rcp7", &"x".repeat(64))), "");
}

#[test]
fn misspelt_keys_are_read_as_what_they_mean() {
    refuses(
        "frequency_hz = 2.0",
        "frequncy_hz = 2.0",
        "s.toml:10: whisking.frequncy_hz: unknown key; did you mean `frequency_hz`? \
         allowed here: frequency_hz, integrator, coupling, noise, gain, start, numbers",
    );
    let sections = "name, tick_hz, duration_s, seed, head, whisking, rcp, cia, motor, plant, \
                    classifier";
    refuses(
        "[whisking]",
        "[whiskng]",
        &format!(
            "s.toml:9: whiskng: unknown key; did you mean `whisking`? allowed here: {sections}"
        ),
    );
    // Both spellings: the right one counts, the other is only reported.
    refuses(
        "tick_hz     = 2000",
        "tickhz = 2\ntick_hz = 2000",
        &format!("s.toml:2: tickhz: unknown key; did you mean `tick_hz`? allowed here: {sections}"),
    );
    refuses(
        "noise        = 0.0",
        "noise = 0.0\ncolour = 3",
        "s.toml:14: whisking.colour: unknown key; \
         allowed here: frequency_hz, integrator, coupling, noise, gain, start, numbers",
    );
}

#[test]
fn keys_in_the_wrong_place() {
    refuses(
        "stiffness = 0.1",
        "stiffness = 0.1\nnoise = 0.1",
        "s.toml:29: plant.noise: unknown key; it belongs to [whisking]; \
         allowed here: kind, obstacle_deg, stiffness, textures, present_s, shaft, length_m, \
         hub_diameter_m, tip_diameter_m, youngs_pa, density_kg_m3, damping_ratio, \
         follicle_n_m_rad",
    );
    refuses(
        "[rcp]",
        "[whisking.rcp]",
        "s.toml:17: whisking.rcp: unknown key; it belongs to the top of the file; \
         allowed here: frequency_hz, integrator, coupling, noise, gain, start, numbers",
    );
}

#[test]
fn broken_toml() {
    refuses(
        "coupling     = true",
        "coupling = yes",
        "s.toml:12: TOML syntax: found coupling = yes; \
         string values must be quoted, expected literal string",
    );
    refuses(
        "[cia]",
        "[cia",
        "s.toml:21: TOML syntax: found [cia; unclosed table, expected `]`",
    );
    // A duplicate does not hide what else is wrong.
    let text = with(FULL, "noise        = 0.0", "noise = 2\nnoise = 0");
    assert_eq!(
        complaint(&text),
        "s.toml:13: whisking.noise: found 2; allowed: a number from 0 to 1\n\
         s.toml:14: noise: found noise = 0; given twice; allowed: once"
    );
}

#[test]
fn unreadable_files_are_named() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let missing = folder.path().join("none.toml");
    let text = Scene::load(&missing).expect_err("no such file").to_string();
    let start = format!("{}: cannot be read: ", missing.display());
    assert!(text.starts_with(&start), "{text}");

    let binary = folder.path().join("binary.toml");
    std::fs::write(&binary, [0xff, 0xfe]).expect("written");
    let text = Scene::load(&binary).expect_err("not UTF-8").to_string();
    assert!(text.contains("binary.toml: cannot be read: "), "{text}");
    assert!(text.contains("UTF-8"), "{text}");
}
