//! The window at all sizes, without a terminal.

use crossterm::event::KeyCode;
use firmware::{Event, EventRecord, Health, Packet, Place};
use host_sim::array::Stand;
use tactile::Decision;
use whisking::motor;
use wire::{Flags, TickRecord};

use crate::monitor::history::History;
use crate::monitor::looking::Hair;
use crate::monitor::shown::Shown;
use crate::monitor::svg::{drawn, svg, text};
use crate::monitor::view::View;
use crate::source::Incoming;

fn history() -> History {
    let mut history = History::new((1000, 1), 2, None);
    for sequence in 1..=6000_u32 {
        let wave = (f64::from(sequence) / 200.0).sin();
        for flags in [Flags::ARMED | Flags::VALID | Flags::TOUCHING, Flags::RIGHT] {
            let record = TickRecord {
                sequence,
                flags,
                x: 32_768 + (3000.0 * wave) as u16,
                y: 32_768,
                setpoint: (4000.0 * wave) as i16,
                measured: (3900.0 * wave) as i16,
                ..TickRecord::default()
            };
            history.take(&Incoming::of([Packet::Record(record)]));
        }
    }
    history.module_classes = vec!["carpet".to_owned()];
    let place = Place::new(0, 0);
    // At odds of 165 to 2^15 against it.
    let decision = Decision::from_memory(640, 165, 0).unwrap();
    let health = Health {
        worst_tenths: 435,
        ..Health::default()
    };
    let events = [
        (5_500, Event::Touch { place, number: 3 }),
        (5_900, Event::Decision(place, decision)),
        (5_950, Event::MotorFault(place, motor::Fault::Stall)),
        (6_000, Event::Health(health)),
    ];
    let event = |(sequence, event)| Packet::Event(EventRecord { sequence, event });
    history.take(&Incoming::of(events.map(event)));
    history
}

#[test]
fn all_is_there_in_the_smallest_usual_window() {
    let shown = Shown::first(&history(), "bench, simulated");
    let buffer = drawn(&shown, (80, 24)).unwrap();
    let text = text(&buffer);
    let words = "bench, simulated|6.00 s  live|[ARMED]|[TOUCHING]|  running |measured|setpoint|contact|\
                 duty|no model: --model|touch 3|carpet 99.50 % 640|fault left 6 does not move|\
                 longest tick 43.5 us (4 %)|lost 0|x stop|q end";
    for word in words.split('|') {
        assert!(text.contains(word), "{word}:\n{text}");
    }
    assert_eq!(text.lines().count(), 24);
    // The line of the chart.
    assert!(text.chars().any(|c| ('\u{2801}'..='\u{28FF}').contains(&c)));
}

#[test]
fn any_window_can_be_drawn() {
    let history = history();
    let mut view = View::new(history.extent());
    for press in ['n', '?', 'p'] {
        view.press(KeyCode::Char(press).into(), history.extent());
        view.press(KeyCode::Tab.into(), history.extent());
        let shown = history.shown(&view, "a title that is longer than some", String::new());
        for size in [(1, 1), (2, 3), (10, 4), (40, 10), (67, 13), (68, 14)] {
            drawn(&shown, size).unwrap();
        }
        drawn(&shown, (200, 60)).unwrap();
    }
}

#[test]
fn a_picture_has_every_word_and_dot_of_the_window() {
    let shown = Shown::first(&history(), "t < & \"");
    let buffer = drawn(&shown, (100, 30)).unwrap();
    let picture = svg(&buffer);
    for word in ["t &lt; &amp;", "[ARMED]", "carpet 99.50 % 640"] {
        assert!(picture.contains(word), "{word}: {picture}");
    }
    let dots: u32 = text(&buffer)
        .chars()
        .filter(|c| ('\u{2800}'..='\u{28FF}').contains(c))
        .map(|c| (c as u32 - 0x2800).count_ones())
        .sum();
    assert!(dots > 100);
    assert_eq!(picture.matches("h2v2h-2z").count() as u32, dots);
}

#[test]
fn a_head_is_seen_from_above_with_who_feels_and_who_decides_what() {
    let hair = |(side, column, contact, said): (usize, usize, f64, &str)| Hair {
        stand: Stand {
            side,
            column,
            row: 0,
            board: Some(7 * side + column),
        },
        columns: 2,
        angle_deg: 84.0,
        contact,
        said: said.to_owned(),
    };
    let mut history = history();
    let left = [(0, 0, 0.0, ""), (0, 1, 0.0, "loam")].map(hair);
    let right = [(1, 0, 0.0, ""), (1, 1, 0.9, "")].map(hair);
    let hairs = [left, right].concat();
    history.see(hairs.clone());
    let drawn_now = |history: &History| {
        let shown = Shown::first(history, "t");
        text(&drawn(&shown, (120, 40)).unwrap())
    };
    // Without what stands beside it.
    let head = |all: &str| -> String {
        let line = |line: &str| line.chars().take(70).chain(['\n']).collect::<String>();
        all.lines().map(line).collect()
    };
    let felt = head(&drawn_now(&history));
    assert!(felt.contains(" 4 whiskers on 9 boards"), "{felt}");
    // Left is left, and what stands behind is below.
    let line = |words: &str| felt.lines().position(|line| line.contains(words)).unwrap();
    let behind = felt.lines().nth(line("loam")).unwrap();
    let [loam, one, eight] = ["loam", "1", "8"].map(|word| behind.find(word).unwrap());
    assert!(loam < one && one < eight, "{behind}");
    assert!(line("0   7") < line("loam"), "{felt}");
    // A circle where it feels, and nowhere else.
    let mut in_air = hairs.clone();
    in_air[3].contact = 0.0;
    history.see(in_air);
    let air = head(&drawn_now(&history));
    let changed: Vec<(usize, usize)> = (felt.lines().zip(air.lines()).enumerate())
        .flat_map(|(row, (felt, air))| {
            let cells = felt.chars().zip(air.chars()).enumerate();
            cells.filter_map(move |(column, (a, b))| (a != b).then_some((row, column)))
        })
        .collect();
    assert!((4..40).contains(&changed.len()), "{changed:?}");
    let near = |(row, column): &(usize, usize)| row.abs_diff(line("loam")) < 4 && *column > 50;
    assert!(changed.iter().all(near), "{changed:?}");
    // Forwards is up.
    let mut protracted = hairs;
    protracted[1].angle_deg += 30.0;
    history.see(protracted);
    let up = head(&drawn_now(&history));
    let name = up.lines().position(|line| line.contains("loam")).unwrap();
    assert!(name + 4 < line("loam"), "{up}");
    // A held picture shows what was then: nothing yet.
    let mut view = View::new(history.extent());
    view.held = Some(3_000);
    assert!(history.shown(&view, "t", String::new()).hairs.is_empty());
}
