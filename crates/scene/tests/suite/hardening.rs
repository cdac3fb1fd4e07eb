//! Whatever stands in a file, reading it ends in a scene or in problems that
//! name the file and a line of it.

use crate::common::FULL;
use proptest::prelude::*;
use proptest::sample::Index;
use scene::Scene;

#[test]
fn what_is_not_to_be_seen_is_refused_in_a_path_and_shown_escaped_elsewhere() {
    let problems = |file: &str, text: &str| Scene::from_str(file, text).unwrap_err().to_string();
    let text = FULL.replacen("\"models/", "\"\\u001b[2Jmodels/", 1);
    let found = problems("s.toml", &text);
    assert!(
        found.contains(r"has the character '\u{1b}', which is not to be seen"),
        "{found}"
    );
    let text = FULL.replacen("\"models/", "\"=1+1", 1);
    assert!(problems("s.toml", &text).contains("which begins with '='"));
    let found = problems("\u{1b}]0;s\u{7}.toml", "'a\u{9b}\u{202e}b' = 1\n");
    assert!(
        !found.replace('\n', "").contains(tactile::name::is_hidden),
        "{found}"
    );
    assert!(found.starts_with(r"\u{1b}]0;s\u{7}.toml:1: "), "{found}");
}

#[test]
fn very_much_that_is_wrong_takes_no_long_time_and_no_long_message() {
    use std::fmt::Write as _;
    use std::time::{Duration, Instant};

    let wrong = |line: &dyn Fn(usize) -> String| {
        let mut text = String::new();
        (0..40_000).for_each(|n| writeln!(text, "{}", line(n)).unwrap());
        let begun = Instant::now();
        let found = Scene::from_str("s.toml", &text).unwrap_err().to_string();
        let took = begun.elapsed();
        assert!(took < Duration::from_secs(2), "{}: {took:?}", line(7));
        assert!(found.len() < 100_000, "{} bytes", found.len());
        found
    };
    let found = wrong(&|n| format!("key_{n} = 1"));
    assert!(found.starts_with("s.toml:1: key_0: unknown key"), "{found}");
    assert!(found.ends_with(" more problems"), "{found}");
    wrong(&|n| format!("tick_hz_{n} = 1"));
    wrong(&|n| format!("[whisking.a{n}]"));
    wrong(&|_| "seed = 1".to_owned());
    wrong(&|n| format!("seed {n}"));
    wrong(&|n| format!("[[plant]]\nx = {n}"));
    wrong(&|n| format!("[[plant.own_{n}]]"));
}

#[test]
fn what_is_nested_deeply_is_refused() {
    for [open, close] in [["[", "]"], ["{a=", "}"], ["a.", ""], ["[[", "]]"]] {
        let (open, close) = (open.repeat(200_000), close.repeat(200_000));
        for text in [
            format!("seed = {open}1{close}\n"),
            format!("{open}a{close} = 1\n"),
            format!("[{open}a{close}]\n"),
        ] {
            assert!(Scene::from_str("s.toml", &text).is_err());
        }
    }
}

/// Pieces that are apt to upset a reader: short ones, and longer ones.
const MARKS: [&str; 37] = [
    "", "\n", "=", "[", "]", "[[", "]]", "{", "}", "\"", "'", "\"\"\"", ",", ".", "#", "-", "0x",
    "nan", "inf", "-inf", "1e999", "-0.0", "true", "[]", "{}", "[[]]", "\u{feff}", "ψ", "\0", "\r",
    "\r\n", "\\", "\"own\"", "\"left\"", "seed", "gain", "_",
];
const WORDS: [&str; 7] = [
    "99999999999999999999",
    "1979-05-27",
    "\"textured\"",
    "\"whisker\"",
    "\"window\"",
    "[motor]\n",
    "[plant]\n",
];

#[derive(Debug, Clone)]
enum Edit {
    Insert(Index, &'static str),
    Remove(Index, usize),
    Replace(Index, usize, &'static str),
    SwapLines(Index, Index),
}

fn piece() -> impl Strategy<Value = &'static str> {
    prop::sample::select([&MARKS[..], &WORDS].concat())
}

fn edit() -> impl Strategy<Value = Edit> {
    let place = || any::<Index>();
    prop_oneof![
        (place(), piece()).prop_map(|(at, new)| Edit::Insert(at, new)),
        (place(), 1..40_usize).prop_map(|(at, n)| Edit::Remove(at, n)),
        (place(), 1..12_usize, piece()).prop_map(|(at, n, new)| Edit::Replace(at, n, new)),
        (place(), place()).prop_map(|(a, b)| Edit::SwapLines(a, b)),
    ]
}

fn apply(text: &str, edit: &Edit) -> String {
    let mut chars: Vec<char> = text.chars().collect();
    let size = chars.len();
    let mut splice = |at: &Index, n: usize, new: &str| {
        let start = at.index(size + 1);
        chars.splice(start..(start + n).min(size), new.chars());
        chars.iter().collect()
    };
    match edit {
        Edit::Insert(at, new) => splice(at, 0, new),
        Edit::Remove(at, n) => splice(at, *n, ""),
        Edit::Replace(at, n, new) => splice(at, *n, new),
        Edit::SwapLines(a, b) => {
            let mut lines: Vec<&str> = text.split('\n').collect();
            let n = lines.len();
            lines.swap(a.index(n), b.index(n));
            lines.join("\n")
        }
    }
}

fn holds_up(text: &str) -> Result<(), TestCaseError> {
    match Scene::from_str("s.toml", text) {
        Ok(scene) => {
            prop_assert!(scene.ticks() >= 1);
            prop_assert_eq!(scene.motor.is_some(), scene.whisking.is_some());
            if let Some(whisking) = scene.whisking {
                let sides = scene.head.sides.count();
                prop_assert_eq!(whisking.gain.len(), sides * scene.head.whiskers_per_side);
                prop_assert_eq!(whisking.start.len(), sides);
            }
        }
        Err(problems) => {
            let lines = 1 + text.matches('\n').count();
            let mut last = 1;
            prop_assert!(!problems.as_slice().is_empty());
            for problem in problems.as_slice() {
                let line = problem.line.unwrap_or(0);
                prop_assert!((last..=lines).contains(&line), "{}", problem);
                prop_assert_eq!(problem.to_string().lines().count(), 1);
                prop_assert!(!problem.key.is_empty() && !problem.found.is_empty());
                last = line;
            }
            // The catalogue covers the whole scene.
            prop_assert!(!problems.to_string().contains("catalogue"));
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 2000, ..Default::default() })]

    #[test]
    fn a_scene_with_edits(edits in prop::collection::vec(edit(), 1..6)) {
        let text = edits.iter().fold(FULL.to_owned(), |text, edit| apply(&text, edit));
        holds_up(&text)?;
    }

    #[test]
    fn any_text(text in any::<String>()) {
        holds_up(&text)?;
    }

    #[test]
    fn any_value_of_any_key(line in 0..36_usize, piece in piece()) {
        let mut lines: Vec<String> = FULL.lines().map(str::to_owned).collect();
        if let Some(line) = lines.get_mut(line)
            && let Some((key, _)) = line.split_once('=')
        {
            *line = format!("{key}= {piece}");
        }
        holds_up(&lines.join("\n"))?;
    }
}
