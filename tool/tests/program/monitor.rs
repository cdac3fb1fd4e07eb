//! `whisker monitor`, as a person has it before them: in a terminal, by its keys.

pub(crate) mod terminal;

use std::time::Duration;

use rustix::process::Signal;
use serde_json::Value;

use crate::common::{Place, contains, scene};
use crate::messages::channels;
use terminal::Terminal;

const SMALL: (u16, u16) = (80, 24);
const CONTROL_C: &[u8] = b"\x03";

/// The records of `r.mcap`, none of which is missing, and whether a `Stop` was answered that it is done.
fn recorded(place: &Place) -> (Vec<Value>, bool) {
    let mut channels = channels(&place.bytes("r.mcap"));
    let records = channels.remove("/left/records").unwrap();
    let records: Vec<_> = records.into_iter().map(|(_, record)| record).collect();
    let number = |record: &Value| record["sequence"].as_u64().unwrap();
    assert!(records.is_sorted_by(|a, b| number(a) + 1 == number(b)));
    let answers = channels.remove("/answers").unwrap_or_default();
    let is_stop = |answer: &Value| answer["command"] == 5 && answer["status"] == 0;
    (records, answers.iter().any(|(_, answer)| is_stop(answer)))
}

/// In how many ticks both have decided, and in how many the module.
fn agreed(text: &str) -> Option<[u32; 2]> {
    let (_, after) = text.split_once("with the module: ")?;
    let (same, after) = after.split_once(" of ")?;
    let all = after.split(|c: char| !c.is_ascii_digit()).next()?;
    Some([same.parse().ok()?, all.parse().ok()?])
}

fn assert_stopped(place: &Place) -> Vec<Value> {
    let (records, is_stopped) = recorded(place);
    assert!(is_stopped);
    let (first, last) = (&records[0], records.last().unwrap());
    assert!(first["armed"] == true && last["armed"] == false);
    assert!(last["duty"] == 0 && last["running"] == false);
    records
}

#[test]
fn a_person_watches_and_stops() {
    let place = Place::new();
    let line = "monitor --sim @textures.toml --out r.mcap --out r.csv";
    let mut seen = Terminal::start(&place, line, SMALL, &[]);
    seen.wait_for("textures, simulated, 2000 Hz");
    for word in ["live", "[ARMED]", "measured", "smooth", "lost 0"] {
        seen.wait_for(word);
    }
    assert!(seen.is_raw() && seen.is_alternate() && seen.has_colour());
    // Of two sides there is one.
    seen.press(b"\t");
    seen.wait_for("touch 1");
    // As often as the module itself decides, so does the PC.
    seen.wait_until(|text| agreed(text).is_some_and(|[same, all]| all >= 3 && same == all));
    assert!(seen.text().contains("\nleft "));

    seen.press(b"p");
    seen.wait_for("PAUSED");
    let held = seen.line("PAUSED").split(" s ").next().unwrap().to_owned();
    seen.wait_until(|text| text.contains("PAUSED") && !text.contains("PAUSED, 0.0"));
    assert!(seen.line("PAUSED").starts_with(&held), "{held}");
    seen.press(b"+");
    seen.press(b"\x1b[D");
    seen.wait_until(|text| !text.contains(&held));
    seen.press(b"s");
    seen.wait_for("saved monitor.csv: ");
    let said = seen.line("saved monitor.csv: ");
    let saved: usize = said.split_whitespace().nth(2).unwrap().parse().unwrap();
    seen.press(b"p");
    seen.wait_for("live");

    seen.press(b"?");
    seen.wait_for("stop: motors off until");
    seen.press(b"?");
    seen.wait_until(|text| !text.contains("motors off until"));
    for (columns, rows) in [(40, 10), (1, 1), (120, 40), SMALL] {
        seen.resize(columns, rows);
        std::thread::sleep(Duration::from_millis(200));
    }
    seen.wait_for("q end");

    seen.press(b"x");
    seen.wait_for("stop: done");
    seen.wait_for("  armed ");
    seen.press(b"a");
    seen.wait_for("arm: done");
    seen.wait_for("[ARMED]");
    seen.press(CONTROL_C);
    assert_eq!(seen.ends(), Some(0));
    assert!(seen.is_restored() && !seen.is_alternate());

    let records = assert_stopped(&place);
    let rows = |name: &str| place.column(name, "sequence").len();
    assert_eq!(rows("r.csv"), records.len());
    // x and a are in it, too: armed, not, armed, not.
    let states = records.iter().map(|record| record["armed"].as_bool());
    let mut states: Vec<bool> = states.map(Option::unwrap).collect();
    states.dedup();
    assert_eq!(states, [true, false, true, false]);
    // Held is what had come by then.
    assert_eq!(rows("monitor.csv"), saved);
    assert!((2000..records.len()).contains(&saved), "{saved}");
}

#[test]
fn motors_stop_where_the_terminal_takes_no_more() {
    let place = Place::new();
    let line = "monitor --sim bench.toml --out r.mcap";
    let mut seen = Terminal::start(&place, line, (200, 60), &[]);
    seen.wait_for("[ARMED]");
    seen.stop_reading();
    // Pictures fill what is between.
    std::thread::sleep(Duration::from_secs(2));
    seen.press(CONTROL_C);
    assert_eq!(seen.ends(), Some(1));
    assert!(seen.is_restored());
    assert_stopped(&place);
}

#[test]
fn motors_stop_before_a_signal_ends_it() {
    for signal in [Signal::TERM, Signal::HUP, Signal::INT] {
        let place = Place::new();
        let line = "monitor --sim bench.toml --out r.mcap";
        let mut seen = Terminal::start(&place, line, SMALL, &[]);
        seen.wait_for("[ARMED]");
        seen.signal(signal);
        assert_eq!(seen.ends(), Some(1));
        assert!(seen.is_restored() && !seen.is_alternate());
        seen.wait_for("the motors were stopped");
        assert_stopped(&place);
    }
}

#[test]
fn who_ends_by_q_leaves_the_module_as_it_is() {
    let place = Place::new();
    let line = "monitor --sim bench.toml --out r.mcap";
    let mut seen = Terminal::start(&place, line, SMALL, &[("NO_COLOR", "1")]);
    seen.wait_for("[ARMED]");
    seen.wait_for("lost 0");
    assert!(!seen.has_colour());
    seen.press(b"q");
    assert_eq!(seen.ends(), Some(0));
    assert!(seen.is_restored());
    let (records, is_stopped) = recorded(&place);
    assert!(!is_stopped);
    assert_eq!(records.last().unwrap()["armed"], true);
}

#[test]
fn a_window_keeps_the_time_and_a_picture_needs_no_terminal() {
    let place = Place::new();
    let begun = std::time::Instant::now();
    let mut seen = Terminal::start(&place, "monitor --sim bench.toml --seconds 2", SMALL, &[]);
    assert_eq!(seen.ends(), Some(0));
    let took = begun.elapsed().as_secs_f64();
    assert!((2.0..8.0).contains(&took), "{took}");

    let monitor = "monitor --sim @textures.toml --frames 60";
    let picture = |more: &str| place.done(&format!("{monitor} {more}")).stdout;
    let text = picture("--size 80x24");
    assert_eq!(text.lines().count(), 24);
    contains(&text, "3.00 s  live");
    contains(&text, "smooth");
    assert_eq!(text, picture("--size 80x24"));
    assert_eq!(picture("--snapshot m.svg"), "");
    assert!(place.text("m.svg").starts_with("<svg"));
    let recording = format!("{monitor} --out r.csv");
    place.done(&recording);
    place.refuses(&recording, "is not overwritten");
    place.refuses("monitor --sim bench.toml", "needs a terminal");
}

#[test]
fn a_head_is_watched_through_any_of_its_boards() {
    let place = Place::new();
    let head = |keys: &str| scene("cia.toml").replace("whiskers_per_side = 1", keys);
    place.write("head.toml", &head("whiskers_per_side = 3\nnodes = 6"));
    let picture = |node: u8| {
        let monitor = "monitor --sim head.toml --frames 40 --size 120x40 --node";
        place.done(&format!("{monitor} {node}")).stdout
    };
    let [left, right] = [0, 3].map(picture);
    assert!(left.contains("\nleft  [ARMED]") && right.contains("\nright [ARMED]"));
    contains(&left, " 6 whiskers on 6 boards");
    // The whisker that is heard is the first of the left.
    assert!(left.contains("touch 1") && !right.contains("touch 1"));
    let monitor = "monitor --sim head.toml --frames 9";
    place.refuses(&format!("{monitor} --node 6"), "--node: found 6");
    place.write("head.toml", &head("whiskers_per_side = 2\nnodes = 2"));
    place.refuses(monitor, "a board a whisker");
}
