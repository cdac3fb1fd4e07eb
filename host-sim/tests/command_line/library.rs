//! The core as a program of one's own uses it: a run owns all that it needs,
//! moves to another thread, and starts again.

use firmware::{Event, Sample};
use host_sim::bus::WireFault;
use host_sim::decisions::Decided;
use host_sim::recording::GATE;
use host_sim::run::Run;
use host_sim::trace::{Row, WhiskerRow};
use scene::Scene;

use crate::common::{IDEAL, SEQUENTIAL, TEXTURED, run};

const fn is_send<T: Send>() {}
const _: () = is_send::<Run>();

fn scene(text: &str, seed: u64) -> Scene {
    let mut scene = Scene::from_str("s.toml", text).unwrap();
    scene.seed = seed;
    scene
}

#[derive(Debug, Default, PartialEq)]
struct Seen {
    rows: Vec<Vec<u64>>,
    samples: Vec<Option<Sample>>,
    decisions: Vec<Decided>,
    events: Vec<Event>,
}

fn see(run: &mut Run) -> Seen {
    let mut seen = Seen::default();
    for _ in 0..run.ticks() {
        seen.rows.push(bits(&run.tick()));
        seen.samples.push(run.sample());
        seen.decisions.extend(run.decisions());
        seen.events.extend_from_slice(run.events());
    }
    seen
}

/// Scenes of every plant, of both motors, in every number format, and of a sensor that holds.
fn scenes() -> Vec<String> {
    let six_step = "[motor]\ndriver = \"six-step\"\n";
    let poses = "gain_spread = 0.05\ntilt_spread_deg = 3\n";
    let elastic = TEXTURED.replace("kind = \"textured\"", "kind = \"whisker\"");
    vec![
        format!("{TEXTURED}{SEQUENTIAL}"),
        format!("{TEXTURED}{six_step}"),
        TEXTURED.replace("noise =", "numbers = \"fixed\"\nnoise ="),
        elastic.replace("exchange = \"timed\"\n", poses),
        TEXTURED.replace("kind =", "hysteresis_codes = 400\nkind ="),
        IDEAL.to_owned(),
        IDEAL.replace("noise =", "numbers = \"f64\"\nnoise ="),
    ]
}

#[test]
fn a_run_that_is_reset_equals_a_new_one() {
    for text in scenes() {
        let first = see(&mut run(&scene(&text, 1)));
        let second = see(&mut run(&scene(&text, 2)));
        let mut again = run(&scene(&text, 1));
        for _ in 0..again.ticks() / 3 {
            again.tick();
        }
        // What was done to it is undone as well.
        again.slave_mut(0).unwrap().set_fault(Some(WireFault::Bus));
        again.reset(2).unwrap();
        assert!(see(&mut again) == second, "{text}");
        again.reset(1).unwrap();
        assert!(see(&mut again) == first, "{text}");
    }
}

fn bits(row: &Row) -> Vec<u64> {
    let pairs = row.pairs();
    pairs.as_flattened().iter().map(|of| of.to_bits()).collect()
}

fn felt(run: &Run) -> Vec<[u64; 4]> {
    let mut whiskers = Vec::new();
    run.look_at_whiskers(&mut whiskers);
    let bits = |whisker: &WhiskerRow| {
        let [x, y] = whisker.codes;
        [whisker.angle_deg, x, y, whisker.contact].map(f64::to_bits)
    };
    whiskers.iter().map(bits).collect()
}

#[test]
fn ticks_without_a_row_change_nothing_and_what_whiskers_feel_is_seen_all_the_same() {
    for text in scenes() {
        let [mut with, mut without] = [(); 2].map(|()| run(&scene(&text, 1)));
        for n in 1..=with.ticks() {
            let row = with.tick();
            if n.is_multiple_of(7) {
                assert_eq!(bits(&without.tick()), bits(&row), "{text} {n}");
            } else {
                without.pass();
            }
            assert_eq!(felt(&with), felt(&without), "{text} {n}");
            assert_eq!(with.sample(), without.sample(), "{text} {n}");
            assert_eq!(with.events(), without.events(), "{text} {n}");
            assert!(with.decisions().eq(without.decisions()), "{text} {n}");
        }
    }
}

#[test]
fn every_whisker_is_classified_by_what_its_sensor_was_given() {
    let shifted = IDEAL.replace("kind =", "zero_codes = [[500, -300], [0, 0]]\nkind =");
    let mut run = run(&scene(&shifted, 1));
    // In the first tick no frame has come yet.
    run.tick();
    run.tick();
    let mut whiskers = Vec::new();
    run.look_at_whiskers(&mut whiskers);
    let codes = whiskers.iter().map(|whisker| whisker.codes);
    let shifted = [8192.0 + 500.0, 8192.0 - 300.0];
    assert!(codes.eq([shifted, shifted, [8192.0; 2], [8192.0; 2]]));
}

#[test]
fn gains_and_setpoints_are_taken_between_ticks() {
    let free = IDEAL.replace("[80.0, 90.0]", "[170.0, 170.0]");
    let mut run = run(&scene(&free, 1));
    let undisturbed = see(&mut run).rows;
    run.reset(1).unwrap();
    let mut theta_deg = |set: fn(&mut Run)| {
        set(&mut run);
        run.tick().theta_deg
    };
    // Limited as position control limits it; the other side goes on.
    let found = theta_deg(|run| run.set_setpoint_deg(0, Some(70.0)).unwrap());
    assert!((found[0] - 70.0).abs() < 1e-5, "{found:?}");
    let found = theta_deg(|run| run.set_setpoint_deg(0, Some(1e9)).unwrap());
    assert!((found[0] - 160.0).abs() < 1e-4, "{found:?}");
    let found = theta_deg(|run| run.set_setpoint_deg(0, None).unwrap());
    assert_eq!(found.map(f64::to_bits), undisturbed[2][..2]);
    // Both whiskers of the left side, the last of which is number 1.
    let gain = |run: &mut Run| (0..2).for_each(|n| run.set_gain(n, 0.5).unwrap());
    theta_deg(gain);
    let nobody = [(4, 1.0), (usize::MAX, 1.0)];
    let nothing = [(0, f64::NAN), (0, f64::INFINITY)];
    for (n, value) in nobody.into_iter().chain(nothing) {
        let set = run.set_gain(n, value);
        assert_eq!(set.unwrap_err().exit_status(), 2);
        let set = run.set_setpoint_deg(n, Some(value));
        assert_eq!(set.unwrap_err().exit_status(), 2);
    }
    // What was set is forgotten.
    run.reset(1).unwrap();
    assert!(see(&mut run).rows == undisturbed);
}

#[test]
fn posteriors_are_seen_between_decisions() {
    assert_eq!(run(&scene(TEXTURED, 1)).posteriors(), None);
    let mut run = run(&scene(&format!("{TEXTURED}{SEQUENTIAL}"), 1));
    let mut highest = |ticks| {
        for _ in 0..ticks {
            run.tick();
        }
        let posteriors: Vec<f64> = run.posteriors().unwrap().to_f64().collect();
        assert_eq!(posteriors.len(), run.classes().len());
        assert!((posteriors.iter().sum::<f64>() - 1.0).abs() < 1e-4);
        let highest = posteriors.into_iter().fold(0.0, f64::max);
        (run.decisions().next(), highest)
    };
    // Equal before the end of the first block, of 20 samples, and after a decision.
    assert_eq!(highest(19), (None, 0.5));
    let mut after = (0..900).map(|_| highest(1));
    let (_, posterior) = after.find(|(decision, _)| decision.is_some()).unwrap();
    assert_eq!(posterior, 0.5);
}

#[test]
fn a_recording_is_what_a_classifier_gets() {
    // Without a classifier the gate is the trainer's.
    let classifier = format!("{SEQUENTIAL}contact_min = {GATE}\n");
    let classifying = run(&scene(&format!("{TEXTURED}{classifier}"), 1));
    let recording = run(&scene(TEXTURED, 1));
    let [decided, recorded] = [classifying, recording].map(|mut run| see(&mut run));
    assert_eq!(decided.samples, recorded.samples);
    assert!(recorded.samples.iter().all(Option::is_some));
}
