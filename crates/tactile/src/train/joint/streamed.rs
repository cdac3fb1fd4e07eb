//! A report of a model with a second opinion: the classifier itself, as it runs on a board, over
//! what its training has not seen.

use std::panic::resume_unwind;
use std::string::String;
use std::thread;
use std::vec::Vec;

use super::model::JointModel;
use super::report::{AtThreshold, ClassReport, PoseReport, USUAL, silent};
use super::run::Decided;
use super::trial::Trial;
use crate::error::ModelError;
use crate::score::Interval;
use crate::sequential::{Sequential, Threshold};
use crate::train::opinion::poses::Poses;
use crate::train_error::TrainError;

/// In how many parts the trials of a class are held out.
const FOLDS: usize = 4;

/// In how many at most, of poses.
const MOST_FOLDS: usize = 8;

/// Replaces the report of a model by one of the classifier as it streams: where each class was
/// felt in several poses each is held out, else some trials of each class. Where these are too few
/// to be held out, the report stays that of tables and floors.
pub(super) fn report(model: &mut JointModel, trials: &[Trial]) -> Result<(), TrainError> {
    let poses = Some(Poses::of(trials)).filter(|poses| are_whole(poses, trials, &model.names));
    let folds = folds(model, trials, poses.as_ref());
    let last = folds.iter().copied().max().unwrap_or(0);
    let thresholds = model.report.calibration.iter().map(|at| at.threshold);
    let thresholds: Vec<f64> = thresholds.collect();
    let of_fold = |fold| of_fold(model, trials, (&folds, fold), &thresholds);
    let of_folds: Vec<Option<Vec<Vec<Decided>>>> = thread::scope(|scope| {
        let begin = |fold| thread::Builder::new().spawn_scoped(scope, move || of_fold(fold));
        let begun: Vec<_> = (0..=last).map(begin).collect();
        let ends = begun.into_iter().enumerate();
        ends.map(|(fold, begun)| match begun {
            Ok(begun) => begun.join().unwrap_or_else(|why| resume_unwind(why)),
            // A browser has no threads.
            Err(_) => of_fold(fold),
        })
        .collect::<Result<_, TrainError>>()
    })?;
    let mut said: Vec<Vec<Decided>> = thresholds.iter().map(|_| Vec::new()).collect();
    for of_fold in of_folds {
        // Too little is left without a part: what there is is not worth less for that.
        let Some(of_fold) = of_fold else {
            return Ok(());
        };
        for (said, of_fold) in said.iter_mut().zip(of_fold) {
            said.extend(of_fold);
        }
    }
    let own = &said[USUAL];
    let report = &mut model.report;
    for (at, said) in report.calibration.iter_mut().zip(&said) {
        *at = AtThreshold::of(at.threshold, said, trials.len());
    }
    for (class, report) in report.classes.iter_mut().enumerate() {
        let of_class = (0..trials.len()).filter(|part| trials[*part].label == report.name);
        *report = ClassReport::of(class, &model.names, trials, report.noticed, own, of_class);
    }
    if let Some(poses) = poses {
        report.poses = of_poses(&poses, own, trials, &model.names);
    }
    Ok(())
}

/// What a model without the trials of one part says of them at each threshold; none where too little is left to train
/// one of the same kind.
fn of_fold(
    model: &JointModel,
    trials: &[Trial],
    (folds, fold): (&[usize], usize),
    thresholds: &[f64],
) -> Result<Option<Vec<Vec<Decided>>>, TrainError> {
    let pick = |is_held_out: bool| {
        let of = trials.iter().enumerate().zip(folds);
        of.filter(move |(_, of)| (**of == fold) == is_held_out)
            .map(|(trial, _)| trial)
    };
    let kept: Vec<Trial> = pick(false).map(|(_, trial)| trial.clone()).collect();
    let Ok(other) = super::once(&kept, &model.options) else {
        return Ok(None);
    };
    let names = |model: &JointModel| model.opinion.as_ref().map(|opinion| opinion.names);
    if other.names.len() != model.names.len() || names(&other) != names(model) {
        return Ok(None);
    }
    let held_out: Vec<(usize, &Trial)> = pick(true).collect();
    let at = |threshold: &f64| stream(&other, &model.names, &held_out, *threshold);
    thresholds
        .iter()
        .map(at)
        .collect::<Result<_, _>>()
        .map(Some)
}

/// Whether each class was felt in several poses.
fn are_whole(poses: &Poses, trials: &[Trial], names: &[String]) -> bool {
    names.iter().all(|name| {
        let of_class = trials.iter().zip(&poses.of_trial);
        let mut of_class = of_class.filter(|(trial, _)| trial.label == *name);
        let first = of_class.next().map(|(_, pose)| pose);
        of_class.any(|(_, pose)| Some(pose) != first)
    })
}

/// With which part each trial is held out.
fn folds(model: &JointModel, trials: &[Trial], poses: Option<&Poses>) -> Vec<usize> {
    if let Some(poses) = poses {
        let of_trial = poses.of_trial.iter();
        return of_trial.map(|pose| pose % MOST_FOLDS).collect();
    }
    let mut seen: Vec<usize> = model.names.iter().map(|_| 0).collect();
    let fold = |trial: &Trial| {
        let class = model.names.iter().position(|name| *name == trial.label);
        let seen = &mut seen[class.unwrap_or(0)];
        *seen += 1;
        (*seen - 1) % FOLDS
    };
    trials.iter().map(fold).collect()
}

/// What a model decides on trials, each for itself; `names` are the classes as they are numbered.
fn stream(
    model: &JointModel,
    names: &[String],
    trials: &[(usize, &Trial)],
    threshold: f64,
) -> Result<Vec<Decided>, TrainError> {
    let threshold = Threshold::new(threshold).map_err(|_| TrainError::NoSamples)?;
    let buffer = model.model()?;
    let number = |name: &String| names.iter().position(|of| of == name).unwrap_or(0);
    let mut classifier =
        Sequential::new(buffer, threshold).map_err(|_| TrainError::Model(ModelError::Opinion))?;
    let mut said = Vec::new();
    for (trial, of) in trials {
        classifier.reset();
        let mut last = 0;
        for (sample, &touch) in of.samples.iter().zip(&of.touches) {
            let codes: [i32; 2] =
                core::array::from_fn(|n| model.scales[n].code_from_f64(sample[n]));
            if touch != 0 && touch != last {
                last = touch;
                classifier.touch(touch);
            }
            if touch == 0 {
                let _ = classifier.pass(&codes);
                continue;
            }
            if let Ok(Some(decision)) = classifier.push(&codes) {
                // Folds may meet classes in another order.
                let class = model.names.get(decision.leader()).map_or(0, number);
                said.push(Decided {
                    piece: *trial,
                    truth: number(&of.label),
                    class,
                    posterior: f64::from(decision.posterior().q32()) / 4_294_967_296.0,
                    samples: decision.samples(),
                    is_named: decision.class().is_some(),
                    entries: [f64::NAN; 2],
                });
            }
        }
    }
    Ok(said)
}

fn of_poses(
    poses: &Poses,
    said: &[Decided],
    trials: &[Trial],
    names: &[String],
) -> Vec<PoseReport> {
    let of = |(pose, name): (usize, &Option<String>)| {
        let is_of = |trial: &usize| poses.of_trial.get(*trial) == Some(&pose);
        let decided = |label: Option<&String>| {
            let of_label = |trial: &usize| label.is_none_or(|label| trials[*trial].label == *label);
            let own = (0..trials.len()).filter(is_of).filter(of_label);
            let [silent, count] = silent(said, own);
            Interval::of(count - silent, count)
        };
        let named = || said.iter().filter(|s| s.is_named && is_of(&s.piece));
        Some(PoseReport {
            name: name.clone()?,
            decided: decided(None),
            hits: Interval::of(named().filter(|s| s.is_right()).count(), named().count()),
            classes: names.iter().map(|name| decided(Some(name))).collect(),
        })
    };
    poses.names.iter().enumerate().filter_map(of).collect()
}
