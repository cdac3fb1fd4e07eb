//! Capturing from modules on bad lines, and by hand.

use host_sim::files::read_recording;
use host_sim::recording::{CHANNELS, GATE, Stream};
use wire::Flags;

use super::*;
use crate::source::{Alter, Altered, Around, GOOD, parsed, scene_file};

/// Captures six touches of a carpet so; the count of warnings, and the touches in each trial.
fn captured(more: &[&str], around: Around, alter: Alter) -> (usize, Vec<usize>) {
    let (warnings, streams) = streams(more, around, alter);
    let of = |stream: &Stream| {
        let mut touches = stream.touch.clone().unwrap();
        touches.dedup();
        touches.retain(|touch| *touch != 0);
        touches.len()
    };
    (warnings, streams.iter().map(of).collect())
}

/// With `more` options: the count of warnings, and what is captured.
fn streams(more: &[&str], around: Around, alter: Alter) -> (usize, Vec<Stream>) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("c.csv");
    let scene = scene_file("textures.toml");
    let [scene, file] = [&scene, &out].map(|path| path.to_str().unwrap());
    let words = ["--label", "carpet", "--touches", "6", "--sim", scene];
    let arguments: Arguments = parsed(&[more, &words, &["--out", file]].concat());
    let source = Altered {
        module: arguments.source.open(0).unwrap(),
        alter,
        around,
    };
    let recording = Recording::open(&out, false, (None, None)).unwrap();
    let labels: Vec<&Label> = arguments.labels.iter().collect();
    let source = Box::new(source);
    let warnings = complete(recording, &labels, source, &arguments, Verbosity::Quiet).unwrap();
    (warnings, read_recording(&out, CHANNELS).unwrap())
}

#[test]
fn what_comes_with_the_last_touch_of_a_label_is_not_lost() {
    let more = ["--label", "smooth"];
    let expected = captured(&more, GOOD, |_, _| true);
    for at_once in [2, 7] {
        let around = Around { at_once, ..GOOD };
        assert_eq!(captured(&more, around, |_, _| true), expected);
    }
}

#[test]
fn lost_records_and_a_fault_cost_their_touch_and_are_reported() {
    let invalid: Alter = |record, _| {
        if (4100..4120).contains(&record.sequence) {
            record.flags = record.flags.without(Flags::VALID);
        }
        true
    };
    // In the third touch: where it is cut another trial begins.
    let lost: Alter = |record, _| record.sequence != 4100;
    for spoils in [lost, invalid] {
        assert_eq!(captured(&[], GOOD, spoils), (2, vec![2, 4]));
    }
}

#[test]
fn another_rate_is_reported() {
    let clock = 1.05;
    let around = Around { clock, ..GOOD };
    assert_eq!(captured(&[], around, |_, _| true).0, 1);
}

#[test]
fn a_person_takes_their_time_and_the_touch_that_they_interrupt_does_not_count() {
    // In a touch, and after a longer time than may pass without one.
    let by_hand = |patience, laid_s| {
        let around = Around { laid_s, ..GOOD };
        streams(&["--patience", patience], around, |_, _| true)
    };
    let (warnings, streams) = by_hand("1", 2.05);
    assert_eq!((warnings, streams.len()), (0, 2));
    let first = &streams[0];
    assert_eq!(first.touch.as_ref().unwrap()[0], 0);
    assert!(first.contact.as_ref().unwrap()[0] < GATE);
    // Soon after that touch has ended, a fifth of a second after the sample was laid.
    let (_, from_the_start) = by_hand("3", 0.001);
    let at = |samples: &[[f64; 2]]| {
        let all = &from_the_start[0].samples;
        all.windows(50).position(|found| found == &samples[..50])
    };
    let at = at(&first.samples).expect("the same world");
    assert!((4100..4700).contains(&at), "{at}");
}

#[test]
fn what_comes_next_depends_on_what_is_there() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("my own.csv");
    let said = |there, is_simulated| super::next(&out, 2000, there, is_simulated);
    assert!(said([1, 1], false).starts_with("next: another sample"));
    let train = said([2, 3], false);
    assert!(train.contains("train --data '") && !train.contains('\n'));
    assert!(said([2, 1], false).contains("three to five are best, and there is 1"));
    // Nobody holds a simulated sample.
    assert!(!said([2, 1], true).contains("pose"));
    let model = folder.path().join("mine.model");
    std::fs::write(&model, b"").unwrap();
    let evaluate = format!("evaluate --model {} --data", model.display());
    assert!(!said([2, 3], false).contains(&evaluate), "it is none");
    std::fs::copy(scene_file("models/textures.model"), &model).unwrap();
    assert!(said([2, 3], false).contains(&evaluate));
}
