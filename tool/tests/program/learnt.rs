//! What is captured is what can be learnt from: as `host-sim record` has it, and nothing that
//! comes from the order of labels.

use host_sim::classifier::Classifier;
use host_sim::commands::record;
use host_sim::decisions::UNKNOWN;
use host_sim::evaluation::presentations;
use host_sim::files::read_recording;
use host_sim::progress::Verbosity;
use host_sim::recording::{CHANNELS, Stream};
use host_sim::scoring;
use host_sim::training::{Expected, How, Tables};
use scene::{Rule, Scene};
use tactile::ModelBuf;

use crate::common::{Place, scenes};

const TICK_HZ: u32 = 2000;

fn main_scene() -> Scene {
    Scene::load(scenes("textures.toml")).unwrap()
}

fn capture(place: &Place, more: &str) -> Vec<Stream> {
    place.done(&format!("capture --sim @textures.toml --out c.csv {more}"));
    let streams = read_recording(&place.path("c.csv"), CHANNELS).unwrap();
    std::fs::remove_file(place.path("c.csv")).unwrap();
    streams
}

fn train(streams: Vec<Stream>, expect: Expected) -> ModelBuf {
    let how = How {
        expect,
        ..How::of(Tables::Joint)
    };
    let trained = how.train(&[("it".to_owned(), streams)], TICK_HZ);
    trained.unwrap().model
}

fn hits(model: &ModelBuf, seed: u64) -> f64 {
    let mut scene = main_scene();
    scene.seed = seed;
    let rule = Rule::Sequential { threshold: 0.99 };
    let classifier = Classifier::new(model.clone(), rule).unwrap();
    let scored = scoring::run(&scene, classifier, || {}).unwrap();
    scored.evaluation.hits.unwrap()
}

#[test]
fn until_the_first_exchange_it_is_what_record_writes() {
    let recorded = record::streams(&main_scene(), Verbosity::Quiet).unwrap();
    let captured = capture(&Place::new(), "--label smooth --touches 3");
    let (recorded, captured) = (&recorded[0], &captured[0]);
    let n = captured.samples.len();
    assert_eq!([&*recorded.label, &*captured.label], ["smooth"; 2]);
    assert!((4000..5000).contains(&n), "{n}");
    assert_eq!(recorded.samples[..n], captured.samples);
    let touches = [recorded, captured].map(|of| &of.touch.as_ref().unwrap()[..n]);
    assert_eq!(touches[0], touches[1]);
    let contacts = recorded.contact.iter().zip(&captured.contact);
    for (recorded, captured) in contacts.flat_map(|(a, b)| a.iter().zip(b)) {
        // Q13, rounded downwards.
        let off = recorded - captured;
        assert!((0.0..1.3e-4).contains(&off), "{recorded} {captured}");
    }
}

#[test]
fn a_model_of_it_scores_as_one_of_what_record_writes() {
    let labels = "--label smooth --label p600 --label p240 --label carpet";
    let captured = capture(&Place::new(), &format!("{labels} --touches 20"));
    let captured = train(captured, Expected::Bench);
    let recorded = record::streams(&main_scene(), Verbosity::Quiet).unwrap();
    let recorded = train(recorded, Expected::Bench);
    let mean = |model| (100..103).map(|seed| hits(model, seed)).sum::<f64>() / 3.0;
    let (captured, recorded) = (mean(&captured), mean(&recorded));
    println!("captured {captured:.3}, recorded {recorded:.3}");
    // Standard error of the difference of three runs of some 200 decisions each: 2 %.
    assert!(recorded > 0.9 && (captured - recorded).abs() < 0.05);
}

/// What training cannot tell apart a second opinion lets nothing name; without one, names are right
/// by chance.
#[test]
fn a_texture_under_two_labels_is_distinguished_by_chance_alone() {
    let place = Place::new();
    let labels = "--label one=p240 --label two=p240 --touches 40";
    let streams = capture(&place, labels);
    let models = [Expected::Bench, Expected::Same].map(|expect| train(streams.clone(), expect));
    let (mut right, mut all) = ([0_u32; 2], [0_u32; 2]);
    for seed in 11..21 {
        let other = capture(&place, &format!("{labels} --seed {seed}"));
        for ((model, right), all) in models.iter().zip(&mut right).zip(&mut all) {
            let shown = presentations(model, 0.7, &other).unwrap();
            let decided = shown.iter().flat_map(|shown| &shown.decided);
            for decided in decided.filter(|decided| decided.decision != UNKNOWN) {
                *right += u32::from(decided.is_right());
                *all += 1;
            }
        }
    }
    println!("{right:?} of {all:?} right");
    assert_eq!(all[0], 0);
    let share = f64::from(right[1]) / f64::from(all[1]);
    // Twice the standard error of so many decisions, of which some share a touch.
    assert!(all[1] > 150 && (share - 0.5).abs() < 0.1);
}
