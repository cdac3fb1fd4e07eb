//! The PC's decisions beside the module's own.

use std::path::Path;

use firmware::{Event, EventRecord, Packet};
use host_sim::decisions;
use tactile::Decision;
use wire::{Command, TickRecord};

use super::{Known, Listener};
use crate::source::{chosen, scene_file};
use crate::tally::Tally;

/// What was decided: tick, side, class, posterior in millionths, samples.
type Row = (u32, usize, String, i64, u32);

fn row(tick: u32, side: usize, decision: Decision, classes: &[String]) -> Row {
    let said = decisions::words(decision, classes);
    let millionths = (1e6 * decision.posterior().to_f64()).floor() as i64;
    (tick, side, said, millionths, decision.samples())
}

/// Listens so long to a module of the kind `how`; `drops` says which records get lost.
/// Returns what the PC decided, and what the module did.
fn listened(
    how: &str,
    scene: &Path,
    seed: &str,
    seconds: f64,
    drops: fn(&TickRecord) -> bool,
) -> [Vec<Row>; 2] {
    let source = chosen(&[how, scene.to_str().unwrap(), "--seed", seed]);
    let known = Known::of(Some(scene), None).unwrap().unwrap();
    let mut module = source.module().unwrap();
    module.ask(Command::Stream(true)).unwrap();
    let [tick_hz, whiskers] = module.ask(Command::Hello).unwrap().values;
    let classes = module.classes().unwrap();
    let mut listener = Listener::new(known, tick_hz as u32, whiskers as usize).unwrap();
    let mut tally = Tally::default();
    let (mut own, mut sent) = (Vec::new(), Vec::new());
    while module.now_s() < seconds {
        let incoming = module.receive().unwrap();
        for packet in &incoming.packets {
            if let Packet::Event(EventRecord { sequence, event }) = packet
                && let Event::Decision(place, decision) = event
            {
                sent.push(row(*sequence, place.side.into(), *decision, &classes));
            }
        }
        for record in incoming.records().filter(|record| !drops(record)) {
            let before = tally.take(record);
            for (side, decision) in listener.take(record, before) {
                own.push(row(record.sequence, side, decision, &classes));
            }
        }
    }
    [own, sent]
}

/// Ticks and sides apart both say the same, to a millionth.
fn assert_same(own: &[Row], sent: &[Row]) {
    for (own, sent) in own.iter().zip(sent) {
        assert_eq!((&own.2, own.4), (&sent.2, sent.4), "{own:?} {sent:?}");
        assert!((own.3 - sent.3).abs() <= 1, "{own:?} {sent:?}");
    }
    assert!(own.len().abs_diff(sent.len()) <= 1);
}

#[test]
fn decisions_are_those_of_the_simulated_module() {
    // Ends of the runs: fewer whisks are in a shorter one.
    for (name, seed, least) in [
        ("textures.toml", "1", 150),
        ("textures.toml", "2", 150),
        ("both.toml", "1", 300),
        ("papers.toml", "1", 200),
        ("whisker.toml", "1", 150),
    ] {
        let [own, sent] = listened("--sim", &scene_file(name), seed, 40.0, |_| false);
        println!("{name}: {} decisions", own.len());
        assert!(own.len() >= least, "{name}: {}", own.len());
        assert_same(&own, &sent);
        let ticks = |all: &[Row]| all.iter().map(|sent| sent.0).collect::<Vec<_>>();
        assert_eq!(ticks(&own), ticks(&sent), "{name}");
    }
}

#[test]
fn decisions_are_those_of_the_emulated_board() {
    let textures = scene_file("textures.toml");
    let [own, sent] = listened("--emulated", &textures, "2", 6.0, |_| false);
    println!("{} decisions", own.len());
    assert!(own.len() >= 20, "{}", own.len());
    assert_same(&own, &sent);
}

#[test]
fn after_lost_records_it_restarts() {
    let drops = |record: &TickRecord| record.sequence == 10_000;
    let [own, sent] = listened("--sim", &scene_file("textures.toml"), "2", 12.0, drops);
    let split = |all: &[Row]| all.iter().filter(|sent| sent.0 < 10_000).count();
    let (before, sent_before) = (split(&own), split(&sent));
    assert_eq!(before, sent_before);
    assert_same(&own[..before], &sent[..before]);
    // What a touch is, is learnt again for a second.
    assert!(own[before].0 > 12_000 && sent[before].0 < 12_000);
    assert!(own.len() > before + 10, "{}", own.len());
}
