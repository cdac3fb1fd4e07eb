//! What a look at a whisker says, beside what it has decided.

use firmware::Packet;
use host_sim::classifier::Classifier;
use host_sim::run::Run;
use wire::{Command, CommandStatus, Looked, TaggedCommand, WhiskerId};

use super::deciding::shipped;
use super::scene;

/// The whisker of each of two boards, looked at in every hundredth tick: how often it has decided
/// and what last is what it has decided by then, and the first leads the second by no angle.
#[test]
fn a_look_says_what_a_whisker_has_decided_last() {
    for (whiskers, deciding) in [("first", 1), ("each", 2), ("together", 1)] {
        let whiskers = format!("classifier.whiskers={whiskers:?}");
        let head = ["head.nodes=2", "head.whiskers_per_side=2"];
        let keys = [&head[..], &["duration_s=10.0", &whiskers]].concat();
        let scene = scene("textures.toml", &keys);
        let model = shipped("textures");
        let mut run = Run::new(&scene, Some(Classifier::of_scene(model, &scene).unwrap())).unwrap();
        let names = run.classes().to_vec();
        let mut made = [(0_u8, None); 2];
        for tick in 1..=run.ticks() {
            run.tick();
            let rows = run.row();
            for decided in run.decisions() {
                let place = decided.place.unwrap();
                let (count, class) = &mut made[usize::from(place.whisker)];
                *count = count.checked_add(1).unwrap();
                *class = names.iter().position(|name| *name == decided.decision);
            }
            if tick % 100 > 0 {
                continue;
            }
            let theta = rows.theta_deg[0];
            for (number, expected) in (0..2).zip(made) {
                let looked = look(&mut run, number);
                let class = looked.class.map(usize::from);
                assert_eq!((looked.decisions, class), expected, "{tick}");
                let angle = f64::from(wire::degrees(looked.measured));
                assert!((angle - theta).abs() < 20.0, "{tick}: {angle} {theta}");
            }
        }
        let deciders = made.iter().filter(|(count, _)| *count > 10).count();
        assert_eq!(deciders, deciding, "{made:?}");
    }
}

fn look(run: &mut Run, number: u8) -> Looked {
    let module = run.module_mut();
    let command = Command::Look(WhiskerId { side: 0, number });
    assert!(module.request_of(number.into(), TaggedCommand { tag: 9, command }));
    let packets = module.take_packets();
    let [Packet::Answer(answer)] = packets.as_slice() else {
        panic!("{packets:?}");
    };
    assert_eq!(answer.status, CommandStatus::Done);
    Looked::of(answer.values)
}
