//! Models that object or name: read whatever their bytes, and refused or sound.

use std::sync::LazyLock;

use proptest::prelude::*;
use tactile::train::Expect;
use tactile::train::joint::{JointModel, Options, Trial, Warning, train};
use tactile::{
    CRC_BYTES, Deciding, Decision, ModelBuf, Pose, RuleSettings, SetupError, StreamClassifier,
    Whisked, checksum,
};

use crate::common;

const WHISKED: Whisked = Whisked {
    frequency_mhz: Some(2000),
    has_rcp: Some(false),
};

/// Uniform in −1 to 1.
pub(crate) fn roll(state: &mut u64) -> f64 {
    2.0 * common::roll(state) - 1.0
}

/// Eight touches, some longer than others, with air between; the tip trembles by `amplitude`
/// codes, and bends by as much in x and y as the pose says.
fn trial(label: &str, amplitude: f64, [x_bend, y_bend]: [f64; 2], seed: u64) -> Trial {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let (mut samples, mut touches) = (Vec::new(), Vec::new());
    for touch in 1..=8_u16 {
        let length = 240 + 20 * usize::from(touch);
        for n in 0..length + 200 {
            let bend = (core::f64::consts::PI * n as f64 / length as f64).sin();
            let is_touching = n < length;
            let [bend, size] = if is_touching {
                [bend, amplitude]
            } else {
                [0.0, 2.0]
            };
            let [x, y] = [0; 2].map(|_| size * roll(&mut state));
            samples.push([
                (8192.0 + x_bend * bend + x).round(),
                (8192.0 + y_bend * bend + y).round(),
            ]);
            touches.push(if is_touching { touch } else { 0 });
        }
    }
    Trial {
        label: label.to_owned(),
        recording: format!("pose {x_bend} {y_bend}"),
        samples,
        touches,
        ..Trial::default()
    }
}

/// What training makes of trials, and the model.
pub(crate) fn learn(trials: impl IntoIterator<Item = Trial>) -> (JointModel, ModelBuf) {
    learn_by(trials, &Options::default())
}

fn learn_by(trials: impl IntoIterator<Item = Trial>, options: &Options) -> (JointModel, ModelBuf) {
    let trained = train(&trials.into_iter().collect::<Vec<_>>(), options).unwrap();
    let model = trained.model().unwrap();
    (trained, model)
}

fn trained(poses: &[f64]) -> ModelBuf {
    let bends: Vec<[f64; 2]> = poses.iter().map(|y_bend| [900.0, *y_bend]).collect();
    expecting(Expect::default(), &bends)
}

fn expecting(expect: Expect, bends: &[[f64; 2]]) -> ModelBuf {
    let trials = bends.iter().zip(0..).flat_map(|(bend, pose)| {
        (0..8).flat_map(move |n| {
            let seed = 16 * pose + 2 * n;
            [("smooth", 20.0, seed), ("rough", 90.0, seed + 1)]
                .map(|(label, amplitude, seed)| trial(label, amplitude, *bend, seed))
        })
    });
    let options = Options {
        whisked: WHISKED,
        expect,
        ..Options::default()
    };
    learn_by(trials, &options).1
}

/// One that objects, one that names, and one that estimates poses.
static MODELS: LazyLock<[ModelBuf; 3]> = LazyLock::new(|| {
    let named = trained(&[-500.0, -300.0, -100.0]);
    [trained(&[-300.0]), named, learnt(0.0).1]
});

#[test]
fn six_classes_with_a_second_opinion_fit_a_small_board() {
    const ROOM: usize = 20 * 1024;
    let classes = ["a", "b", "c", "d", "e", "f"].into_iter().zip(1..);
    let trials = classes.flat_map(|(label, n)| {
        let seeds = [2 * n as u64, 2 * n as u64 + 1];
        seeds.map(|seed| trial(label, f64::from(15 * n), [900.0, -300.0], seed))
    });
    let (_, model) = learn(trials);
    assert!(model.has_opinion());
    let bytes = model.as_bytes().len();
    assert!(bytes <= ROOM, "{bytes} bytes");
}

/// A trial that says how what it touches stands: where rough turns a deflection by as much more as
/// `friction`, as friction does, the tilt is y over x, and the depth the size of both.
fn standing(label: &str, friction: f64, n: u64) -> Trial {
    let mut state = n.wrapping_mul(0x2545_f491_4f6c_dd1d) | 1;
    let [tilt, depth] = [0; 2].map(|_| roll(&mut state));
    let [tilt, depth] = [20.0 + 5.0 * tilt, 8.0 + 2.0 * depth];
    let [amplitude, turn] = if label == "rough" {
        [60.0, friction]
    } else {
        [20.0, 0.0]
    };
    let (sin, cos) = (tilt + turn).to_radians().sin_cos();
    let trial = trial(label, amplitude, [cos, sin].map(|of| 100.0 * depth * of), n);
    Trial {
        recording: "one".to_owned(),
        pose: Some(n.to_string()),
        stands: Some([tilt, depth]),
        ..trial
    }
}

/// Two classes in 24 poses each, with what is said of how they stand changed.
fn standings(friction: f64, change: impl Fn([f64; 2]) -> [f64; 2]) -> Vec<Trial> {
    let trial = |n| {
        let trial = standing(["smooth", "rough"][n as usize % 2], friction, n);
        let stands = trial.stands.map(&change);
        Trial { stands, ..trial }
    };
    (0..48).map(trial).collect()
}

/// A model of 24 poses of two classes, and the errors that it expects after six blocks.
fn learnt(friction: f64) -> (Vec<[f64; 2]>, ModelBuf) {
    let options = Options {
        whisked: WHISKED,
        ..Options::default()
    };
    let (trained, model) = learn_by(standings(friction, |as_it_is| as_it_is), &options);
    let errors = trained.opinion.unwrap().pose_errors;
    (errors.iter().map(|stages| stages[5]).collect(), model)
}

/// The first so many bytes of a model with some changed, and the sum that belongs to them.
fn changed(model: &ModelBuf, length: usize, changes: &[(usize, u8)]) -> Vec<u8> {
    let mut bytes = model.as_bytes()[..length - CRC_BYTES].to_vec();
    for (at, byte) in changes {
        let at = at % bytes.len();
        bytes[at] = *byte;
    }
    bytes.extend(checksum(&bytes).to_le_bytes());
    bytes
}

/// What a model decides of a trial, and the pose of what it names.
pub(crate) fn decisions(model: &ModelBuf, trial: &Trial) -> Vec<(Decision, Option<Pose>)> {
    let rule = RuleSettings::Sequential(common::threshold(0.99));
    let mut classifier = StreamClassifier::new(model.view(), rule, Deciding::First, 1).unwrap();
    let (mut all, mut last) = (Vec::new(), 0);
    for (sample, touch) in trial.samples.iter().zip(&trial.touches) {
        let codes = [0, 1].map(|channel| {
            let quantiser = model.quantiser(channel).unwrap();
            quantiser.code_from_f64(sample[channel])
        });
        if *touch == 0 {
            classifier.pass_to(0, &codes).unwrap();
            continue;
        }
        if *touch != last {
            last = *touch;
            classifier.begin_touch(0, last);
        }
        if let Some(decision) = classifier.push_to(0, &codes).unwrap() {
            let named = decision.class();
            all.push((decision, named.and_then(|class| classifier.pose(0, class))));
        }
    }
    all
}

/// Streams noise through a model, with touches, gaps and air.
fn streams(model: &ModelBuf, seed: u64) {
    let threshold = RuleSettings::Sequential(common::threshold(0.9));
    let window = RuleSettings::Window(3 * model.block());
    for rule in [threshold, window] {
        for deciding in [Deciding::First, Deciding::Together] {
            let Ok(mut classifier) = StreamClassifier::new(model.view(), rule, deciding, 2) else {
                continue;
            };
            let (mut state, mut size) = (seed, 10.0);
            let mut codes = vec![0; model.channels()];
            for n in 0..3_000_usize {
                if n % 50 == 0 {
                    // From nothing to beyond what any sensor has.
                    size = (31.0 * roll(&mut state).abs()).exp2();
                }
                for code in &mut codes {
                    *code = (8192.0 + size * roll(&mut state)) as i32;
                }
                let whisker = n / 10 % classifier.streams();
                match n % 500 {
                    0..10 => classifier.begin_touch(whisker, (n / 500) as u16),
                    300 => classifier.interrupt_stream(whisker),
                    400.. => classifier.pass_to(whisker, &codes).unwrap(),
                    _ => {
                        let decision = classifier.push_to(whisker, &codes).unwrap();
                        let leader = decision.map_or(0, |decision| decision.leader());
                        assert!(leader < model.classes());
                        let pose = classifier.pose(whisker, leader);
                        assert!(pose.is_none() || model.has_pose());
                    }
                }
            }
        }
    }
}

#[test]
fn models_of_one_pose_object_and_of_several_name() {
    let [objects, names, estimates] = &*MODELS;
    assert!(estimates.has_pose() && !names.has_pose());
    assert!(objects.has_opinion() && names.has_opinion());
    assert_eq!((objects.poses(), names.poses()), (1, 3));
    assert_eq!([objects.whisked(), names.whisked()], [WHISKED; 2]);
    let made = |model: &ModelBuf, rule| {
        let classifier = StreamClassifier::new(model.view(), rule, Deciding::First, 1);
        classifier.map(|_| ())
    };
    let window = RuleSettings::Window(80);
    assert_eq!(made(objects, window), Ok(()));
    assert_eq!(made(names, window), Err(SetupError::WindowNames));
    for model in &*MODELS {
        streams(model, 1);
    }
    // What remains is what training makes where nothing differs.
    assert!(names.without_opinion().is_none());
    let without = objects.without_opinion().unwrap();
    let same = expecting(Expect::Same, &[[900.0, -300.0]]);
    assert_eq!(without.as_bytes(), same.as_bytes());
    assert!(same.without_opinion().is_none());
}

/// Trained in three poses by one sensor, and felt by another: rough is named as far as the turn or
/// the scale was to be expected, and beyond it nothing is.
#[test]
fn a_sensor_may_be_turned_and_scaled_as_far_as_is_expected() {
    use Expect::{Bench, Other, Same};
    let poses = [1000.0, 1400.0, 1800.0].map(|x_bend| [x_bend, 600.0]);
    for expect in [Same, Bench, Other] {
        let model = expecting(expect, &poses);
        let rough = model.names().position(|name| name == "rough").unwrap();
        for (degrees, scale, allowed) in [
            (0.0_f64, 1.0, &[Same, Bench, Other][..]),
            (5.0, 1.0, &[Bench, Other]),
            (-5.0, 1.0, &[Bench, Other]),
            (20.0, 1.0, &[Other]),
            (-40.0, 1.0, &[]),
            (0.0, 1.2, &[Bench, Other]),
            (0.0, 2.5, &[]),
        ] {
            let mut felt = trial("rough", 90.0, [1400.0, 600.0], 77);
            let (sin, cos) = degrees.to_radians().sin_cos();
            for [x, y] in &mut felt.samples {
                let (dx, dy) = (*x - 8192.0, *y - 8192.0);
                *x = (8192.0 + cos * dx - sin * dy).round();
                *y = (8192.0 + scale * (sin * dx + cos * dy)).round();
            }
            let decisions = decisions(&model, &felt);
            let named: Vec<_> = decisions.iter().filter_map(|(of, _)| of.class()).collect();
            assert!(named.iter().all(|class| *class == rough));
            // Of eight touches; the shortest say little of their way.
            let range = if allowed.contains(&expect) {
                6..=8
            } else {
                0..=2
            };
            let is_right = range.contains(&named.len());
            assert!(is_right, "{expect:?} {degrees} {scale}: {named:?}");
        }
    }
}

/// Both tremble alike, and bend in three poses: only by how far they bend can they be told apart.
#[test]
fn surfaces_that_tremble_alike_are_named_by_their_deflection() {
    let poses = [-500.0, -300.0, -100.0];
    let surfaces = |y_bend: f64, first: u64| {
        let of = [("soft", 400.0), ("hard", 900.0)].into_iter().zip(first..);
        of.map(move |((label, x_bend), seed)| Trial {
            recording: y_bend.to_string(),
            ..trial(label, 40.0, [x_bend, y_bend], seed)
        })
    };
    let in_poses = poses.iter().zip([100, 200, 300]);
    let trials =
        in_poses.flat_map(|(pose, seed)| (0..4).flat_map(move |n| surfaces(*pose, seed + 2 * n)));
    let (_, model) = learn(trials);
    for felt in surfaces(-200.0, 900) {
        let class = model.names().position(|name| name == felt.label);
        let decisions = decisions(&model, &felt);
        let named: Vec<_> = decisions.iter().filter_map(|(of, _)| of.class()).collect();
        let are_right = named.iter().all(|of| Some(*of) == class);
        assert!(are_right && named.len() >= 6, "{}: {named:?}", felt.label);
    }
}

/// Where it would lie beyond what was trained, an estimate stays there, and its error says so.
#[test]
fn an_estimate_beyond_what_was_trained_says_a_larger_error() {
    let (_, model) = learnt(0.0);
    let class = model.names().position(|name| name == "rough");
    for (tilt, least) in [(28.0, 2.0), (33.0, 5.0)] {
        let (sin, cos) = f64::to_radians(tilt).sin_cos();
        let trial = trial("rough", 60.0, [800.0 * cos, 800.0 * sin], 200);
        let rule = RuleSettings::Sequential(common::threshold(0.99));
        let mut classifier = StreamClassifier::new(model.view(), rule, Deciding::First, 1).unwrap();
        classifier.begin_touch(0, 1);
        let felt = trial.samples.iter().zip(&trial.touches);
        for (sample, _) in felt.take_while(|(_, touch)| **touch == 1) {
            classifier
                .push_to(0, &sample.map(|code| code as i32))
                .unwrap();
        }
        let pose = classifier.pose(0, class.unwrap()).unwrap();
        assert!(pose.tilt.value() <= 25.0, "{pose:?}");
        assert!(
            pose.tilt.value() + pose.tilt.error() >= tilt - 1.0,
            "{pose:?}"
        );
        assert!(pose.tilt.error() > least, "{pose:?}");
    }
}

/// What is called alike is of one pose, however often it was measured.
#[test]
fn poses_that_are_measured_twice_are_held_out_together() {
    let errors = |jitter: f64| {
        let mut trials = standings(3.0, |stands| stands);
        let again = trials.clone().into_iter().enumerate();
        trials.extend(again.map(|(n, trial)| {
            Trial {
                stands: trial
                    .stands
                    .map(|[tilt, depth]| [tilt + jitter * n as f64, depth]),
                ..trial
            }
        }));
        learn(trials).0.opinion.unwrap().pose_errors[0][5][0]
    };
    let [expected, found] = [0.0, 1e-4].map(errors);
    assert!((found / expected - 1.0).abs() < 0.01, "{found} {expected}");
}

/// Of poses that were not trained: as near as is said, and that is a tenth of their spread at most,
/// though one class turns the deflection by three degrees more.
#[test]
fn poses_are_estimated_of_the_class_that_is_named() {
    let (expected, model) = learnt(3.0);
    let classes: Vec<String> = model.names().map(str::to_owned).collect();
    for (class, name) in classes.iter().enumerate() {
        let (mut squares, mut stated, mut count) = ([0.0_f64; 2], [0.0_f64; 2], 0.0);
        for n in 100..130 {
            let trial = standing(name, 3.0, n);
            for (decision, pose) in decisions(&model, &trial) {
                let Some(named) = decision.class() else {
                    continue;
                };
                assert_eq!(named, class);
                let pose = pose.unwrap();
                for (n, estimate) in [pose.tilt, pose.depth].into_iter().enumerate() {
                    let error = estimate.value() - trial.stands.unwrap()[n];
                    squares[n] += error * error;
                    stated[n] += estimate.error().powi(2);
                }
                count += 1.0;
            }
        }
        assert!(count >= 100.0, "{name}: {count}");
        for (n, spread) in [10.0, 4.0].into_iter().enumerate() {
            let found = (squares[n] / count).sqrt();
            let said = (stated[n] / count).sqrt();
            assert!(found < 0.1 * spread, "{name}: {found} of {spread}");
            assert!(
                (0.5..1.5).contains(&(found / said)),
                "{name}: {found}, said {said}"
            );
            assert!(expected[class][n] < 0.1 * spread, "{name}: {expected:?}");
        }
    }
}

/// A placebo: of poses that belong to other presentations nothing is learnt, and the errors are
/// those of guessing the middle of ±5 and ±2 of even chance.
#[test]
fn poses_of_others_are_only_guessed() {
    let all = standings(0.0, |as_it_is| as_it_is);
    let permuted = (0..all.len()).map(|n| Trial {
        stands: all[(n + 18) % all.len()].stands,
        ..all[n].clone()
    });
    for stages in &learn(permuted).0.opinion.unwrap().pose_errors {
        for [tilt, depth] in stages {
            assert!((2.2..4.0).contains(tilt), "{tilt}");
            assert!((0.85..1.6).contains(depth), "{depth}");
        }
    }
}

#[test]
fn a_depth_that_cannot_be_said_or_never_differs_is_not_learnt() {
    let lacks = Warning::NoPose {
        name: "smooth".to_owned(),
        what: "values of tilt_deg or depth_deg",
        found: 1,
        least: 6,
    };
    let too_deep = standings(0.0, |[tilt, depth]| [tilt, 320.0 + depth]);
    let alike = standings(0.0, |[tilt, _]| [tilt, 8.0]);
    for (trials, is_wide) in [(too_deep, true), (alike, false)] {
        let (trained, model) = learn(trials);
        let mut warnings = trained.report.warnings.into_iter();
        assert!(warnings.any(|warning| match warning {
            Warning::WidePose { .. } => is_wide,
            other => other == lacks && !is_wide,
        }));
        assert!(!model.has_pose());
    }
}

#[test]
fn whisking_differs_by_a_twentieth_or_by_rcp() {
    let at = |mhz, has_rcp| Whisked {
        frequency_mhz: mhz,
        has_rcp,
    };
    for (other, differs) in [
        (at(Some(2100), Some(false)), false),
        (at(Some(1900), None), false),
        (at(Some(2101), Some(false)), true),
        (at(Some(1899), None), true),
        (at(None, Some(true)), true),
        (at(None, None), false),
    ] {
        assert_eq!(WHISKED.differs(&other), differs, "{other:?}");
    }
}

#[test]
fn a_cut_file_is_refused() {
    for model in &*MODELS {
        let bytes = model.as_bytes();
        // Its header says so, and its sum is right.
        for length in (20..bytes.len()).step_by(4) {
            let announced = (length as u32).to_le_bytes();
            let changes: Vec<_> = (12..).zip(announced).collect();
            let cut = ModelBuf::from_bytes(&changed(model, length, &changes));
            assert!(cut.is_err(), "{length}");
        }
    }
}

proptest! {
    #[test]
    fn whatever_its_bytes_a_model_is_refused_or_streams(
        which in 0..3_usize,
        near_end in any::<bool>(),
        changes in prop::collection::vec((any::<u16>(), any::<u8>()), 0..12),
        seed in any::<u64>(),
    ) {
        let model = &MODELS[which];
        let length = model.as_bytes().len();
        // The opinion lies at the end.
        let within = |at: u16| {
            let at = usize::from(at);
            if near_end { length - CRC_BYTES - 1 - at % (length / 2) } else { at % 400 }
        };
        let changes: Vec<_> = changes.into_iter().map(|(at, byte)| (within(at), byte)).collect();
        match ModelBuf::from_bytes(&changed(model, length, &changes)) {
            Ok(read) => streams(&read, seed),
            Err(error) => prop_assert!(!error.to_string().is_empty()),
        }
    }
}
