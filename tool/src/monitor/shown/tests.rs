//! What is shown of records and lines.

use firmware::{Event, EventRecord, Packet, Place};
use whisking::motor;
use wire::{Flags, TickRecord};

use super::Fault;
use crate::monitor::history::History;
use crate::monitor::listener::{Known, Listener};
use crate::monitor::shown::Shown;
use crate::source::{Incoming, record, scene_file};

/// Records of four seconds at 1 kHz, a peak of one tick in the third, with a fault.
fn history() -> History {
    let mut history = History::new((1000, 1), 1, None);
    for sequence in 1..=4000 {
        let measured = if sequence == 2500 { 8192 } else { 0 };
        let record = TickRecord {
            measured,
            ..record(sequence, Flags::default())
        };
        let fault = (sequence == 2000).then_some(Packet::Event(EventRecord {
            sequence,
            event: Event::MotorFault(Place::new(0, 0), motor::Fault::Runaway),
        }));
        let packets = [Packet::Record(record)].into_iter().chain(fault);
        history.take(&Incoming::of(packets.collect::<Vec<_>>()));
    }
    history
}

#[test]
fn a_peak_of_one_tick_is_in_the_picture_where_it_was() {
    let history = history();
    let shown = Shown::first(&history, "t");
    assert_eq!((shown.from_s, shown.to_s), (-1.0, 4.0));
    let measured = &shown.whiskers[0].curves[1];
    let mut peaks = measured.clone();
    peaks.retain(|(_, deg)| *deg == 150.0);
    assert_eq!(peaks.len(), 1);
    assert!((peaks[0].0 - 2.5).abs() < 0.03, "{peaks:?}");
    assert!(measured.iter().all(|(_, deg)| [50.0, 150.0].contains(deg)));
    assert!(measured.len() < 400);
}

#[test]
fn faults_come_with_cause_and_remedy() {
    let shown = Shown::first(&history(), "t");
    let expected = Fault {
        what: "2.000 fault left 8 runs away (motor or encoder wired the wrong way round; noise on \
               the encoder's lines?)"
            .to_owned(),
        remedy: "exchange the motor's two wires, or A and B; top_speed_deg_s".to_owned(),
    };
    assert_eq!(shown.faults, [expected]);
}

#[test]
fn it_is_said_that_the_classifier_has_started_again() {
    let known = Known::of(Some(&scene_file("textures.toml")), None);
    let listener = Listener::new(known.unwrap().unwrap(), 2000, 1);
    let mut history = History::new((2000, 1), 1, Some(listener.unwrap()));
    let mut take = |sequence| {
        let record = record(sequence, Flags::VALID);
        history.take(&Incoming::of([Packet::Record(record)]));
        let shown = Shown::first(&history, "t");
        shown.classifying.join("\n")
    };
    let said = [1, 2, 3001, 3002, 1].map(&mut take);
    assert!(said[1].starts_with("computed on the PC from records"));
    assert!(!said[1].contains("again from"));
    let lost = "again from 1.5 s: records were lost";
    assert!(said[2..4].iter().all(|said| said.contains(lost)));
    assert!(said[4].contains("the module started again"), "{}", said[4]);
}
