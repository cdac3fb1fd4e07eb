//! Faulty scenes, and what is said of them; refusals.toml has most of them.

use crate::common::{FULL, PASSIVE, complaint, left, with};
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
        let text = match case.get("of").and_then(Value::as_str) {
            None => FULL,
            Some("left") => &left(),
            Some("passive") => PASSIVE,
            Some(nothing) => nothing.trim_start_matches("nothing"),
        };
        let mut text = with(text, old, new);
        if let Some(more) = case.get("and") {
            let [old, new] = texts([&more[0], &more[1]]);
            text = with(&text, old, new);
        }
        assert_eq!(complaint(&text), says, "{new}");
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
fn all_problems_are_listed_in_file_order() {
    let text = with(FULL, "name        = \"rcp7\"", "name = 'a b'");
    let text = with(&text, "duration_s  = 6.0", "duration = 0");
    let text = with(&text, "frequency_hz = 2.0", "frequncy_hz = 200");
    let text = with(&text, "noise        = 0.0", "noise = -1");
    let text = with(&text, "[cia]", "[cio]");
    let text = with(&text, "kind      = \"ideal\"", "kind = 3");
    let text = with(&text, "threshold = 0.99\n", "");
    let problems = Scene::from_str("s.toml", &text).expect_err("all is wrong");
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
