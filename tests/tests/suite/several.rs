//! Decisions of several whiskers: each by itself as one that is heard alone, and all
//! together by the sum of their evidence.

use firmware::{Place, Sample, SampleClassifier};
use host_sim::bus::WireFault;
use host_sim::classifier::Classifier;
use host_sim::decisions::{Decided, UNKNOWN};
use host_sim::evaluation::Evaluation;
use host_sim::run::Run;
use host_sim::scoring::{self, Heard, Scored};
use scene::{Deciding, Rule, Scene};
use tactile::ModelBuf;

/// Seeds that nothing was trained on or chosen by.
const SEEDS: core::ops::Range<u64> = 300..306;

fn both(deciding: Deciding) -> Scene {
    let text = include_str!("../../../scenes/both.toml");
    let mut scene = Scene::from_str("both.toml", text).unwrap();
    let classifier = scene.classifier.as_mut().unwrap();
    assert_eq!(classifier.whiskers, Deciding::Together);
    classifier.whiskers = deciding;
    scene
}

fn classifier(deciding: Deciding) -> Classifier {
    let model = ModelBuf::from_bytes(include_bytes!("../../../scenes/models/both.model")).unwrap();
    let rule = Rule::Sequential { threshold: 0.99 };
    Classifier::of(model, rule, deciding).unwrap()
}

fn scored(deciding: Deciding) -> (Evaluation, f64) {
    let mut scene = both(deciding);
    let runs = SEEDS.map(|seed| {
        scene.seed = seed;
        scoring::run(&scene, classifier(deciding), || ()).unwrap()
    });
    let runs: Vec<Scored> = runs.collect();
    let classes = classifier(deciding).classes().to_vec();
    let shown = runs.iter().flat_map(|run| &run.presentations).cloned();
    let shown: Vec<_> = shown.collect();
    let wall = runs.iter().map(|run| run.wall).sum::<f64>() / runs.len() as f64;
    (Evaluation::new(&classes, &shown), wall)
}

/// What is stated is what is found, and two decide in less time than one.
#[test]
fn together_they_are_as_sure_as_they_say_and_sooner() {
    let (first, first_wall) = scored(Deciding::First);
    let (together, wall) = scored(Deciding::Together);
    let found = together.calibration.found;
    println!("stated {}, found {found:?}", together.calibration.stated);
    println!("{wall} ticks, the first alone {first_wall}");
    assert!(found.count > 1500 && found.share > 0.99, "{found:?}");
    assert!((found.share - together.calibration.stated).abs() < 0.005);
    assert!((0.4..0.65).contains(&(wall / first_wall)));
    assert!(first.calibration.found.count < found.count);
}

/// Of each whisker that is heard, in one tick.
type Samples = Vec<Option<Sample>>;

/// A run, sample by sample: the events of the module, and what each whisker sent.
fn played(deciding: Deciding, mut act: impl FnMut(u64, &mut Run)) -> (Vec<Decided>, Vec<Samples>) {
    let mut run = Run::new(&both(deciding), Some(classifier(deciding))).unwrap();
    let (mut decided, mut heard) = (Vec::new(), Vec::new());
    for tick in 0..20_000 {
        act(tick, &mut run);
        run.tick();
        decided.extend(run.decisions());
        heard.push(run.samples().to_vec());
    }
    (decided, heard)
}

#[test]
fn each_decides_as_one_that_is_heard_alone() {
    let (decided, heard) = played(Deciding::Each, |_, _| {});
    for side in 0..2 {
        let place = Some(Place::new(side, 0));
        let its = decided.iter().filter(|d| d.place == place);
        let its = its.map(|d| (d.t_s.unwrap(), d.posterior, d.touch));
        let its: Vec<_> = its.collect();
        assert!(its.len() > 30, "{}", its.len());
        let mut alone = classifier(Deciding::First);
        let mut expected = Vec::new();
        for (tick, samples) in (1..).zip(&heard) {
            let t_s = f64::from(tick) / 2000.0;
            let decision = alone
                .codes_mut()
                .push(0, samples[usize::from(side)].unwrap());
            expected.extend(decision.map(|d| (t_s, d.posterior().to_f64(), d.touch())));
        }
        assert_eq!(its, expected);
    }
    // The first of the array is the left one, whoever else is heard.
    let (first, heard) = played(Deciding::First, |_, _| {});
    let left = decided.iter().filter(|d| d.place == Some(Place::new(0, 0)));
    assert_eq!(first, left.cloned().collect::<Vec<_>>());
    assert!(heard.iter().all(|samples| samples.len() == 1));
}

#[test]
fn what_is_heard_together_is_scored_as_it_is_run() {
    let mut scene = both(Deciding::Together);
    scene.duration_s = 10.0;
    scene.seed = 77;
    let heard = Heard::record(&scene).unwrap();
    let live = scoring::run(&scene, classifier(Deciding::Together), || ()).unwrap();
    let replayed = heard.score(classifier(Deciding::Together));
    assert!(live.evaluation.calibration.found.count > 50);
    assert_eq!(replayed.presentations, live.presentations);
    assert_eq!(replayed.wall, live.wall);
}

/// Half of the run without the right sensor: no block of its makes a decision fall, and
/// the left whisker goes on by itself.
#[test]
fn a_lost_side_has_no_part_in_what_is_decided_together() {
    let (from, to) = (8000, 14_000);
    let (decided, heard) = played(Deciding::Together, |tick, run| {
        let fault = (from..to).contains(&tick).then_some(WireFault::Silent);
        run.slave_mut(1).unwrap().set_fault(fault);
    });
    let within = |d: &&Decided| {
        let t_s = d.t_s.unwrap();
        (4.1..7.0).contains(&t_s)
    };
    let fallen: Vec<_> = decided.iter().filter(within).collect();
    let right = |d: &&&Decided| d.decision != UNKNOWN && d.is_right();
    assert!(fallen.iter().all(|d| d.place == Some(Place::new(0, 0))));
    assert!(fallen.len() > 5, "{}", fallen.len());
    assert!(fallen.iter().filter(right).count() * 10 > fallen.len() * 8);
    let after = decided.iter().filter(|d| d.t_s.unwrap() > 7.1);
    assert!(after.filter(|d| d.place == Some(Place::new(1, 0))).count() > 8);
    let silent = heard.iter().filter(|samples| samples[1].is_none()).count() as u64;
    // Fifteen ticks are bridged; eighty good frames make it trusted again.
    assert_eq!(silent, to - from - 15 + 79);
    assert!(heard.iter().all(|samples| samples[0].is_some()));
}
