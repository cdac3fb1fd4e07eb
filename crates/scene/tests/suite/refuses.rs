//! Faulty scenes, and what is said of them; refusals.toml has most of them.

use crate::common::{FULL, complaint, with};
use scene::Scene;
use toml::{Table, Value};

/// Edges of ranges, problems of one key at a time, and keys that do not go together.
fn refusals() -> Table {
    let table = include_str!("refusals.toml").parse();
    table.expect("refusals.toml is a table")
}

fn texts<const N: usize>(of: [&Value; N]) -> [&str; N] {
    of.map(|value| value.as_str().expect("a string"))
}

#[test]
fn every_fault_is_reported_with_its_line_and_what_is_allowed() {
    let refusals = refusals();
    for case in refusals["case"].as_array().expect("a list") {
        let [old, new, says] = texts(["old", "new", "says"].map(|key| &case[key]));
        assert_eq!(complaint(&with(FULL, old, new)), says, "{new}");
    }
}

/// The edge of every numeric range: the first value is in, the second is out.
#[test]
fn edges_of_ranges() {
    let refusals = refusals();
    for edge in refusals["edges"].as_array().expect("a list") {
        let [old, key, inside, outside] = texts([0, 1, 2, 3].map(|column| &edge[column]));
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
        let is_one = complaint.lines().count() == 1 && complaint.contains("; allowed: ");
        assert!(is_one, "{key}{outside}: {complaint:?}");
    }
}

#[test]
fn names_must_suit_file_names() {
    let allowed = "allowed: 1 to 64 of the letters A-Z and a-z, the digits, '-', '_' and '.', \
                   not dots alone";
    for bad in ["", "a/b", "..", "a b", "ä", &"x".repeat(65)] {
        let text = with(FULL, "\"rcp7\"", &format!("{bad:?}"));
        let complaint = complaint(&text);
        let is_of_name = complaint.starts_with("s.toml:1: name: found \"");
        assert!(is_of_name && complaint.ends_with(allowed), "{complaint}");
    }
    assert_eq!(complaint(&with(FULL, "rcp7", &"x".repeat(64))), "");
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
