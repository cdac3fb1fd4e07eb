//! Training the joint model from labelled trials: tables, weights, floors and a
//! report, in double precision.
//!
//! 1. Blocks: what the module will see of a trial: blocks of counted
//!    samples in order, dropped at the onset of a touch, and their roughness.
//! 2. Tables: per class a joint histogram over the 0.2 to 99.8 % quantiles of both
//!    channels, smoothed; one of samples, one of the roughness of blocks.
//! 3. Weights: samples, and tables, are not independent. Evidence of a block =
//!    Σ wₜ · mean of log₂ p of table t; the w ≥ 0 minimise the log loss over
//!    stretches of blocks that their tables have not seen, and that floors let pass.
//!    Where no second opinion objects to names, they are lowered until the first names
//!    of trials are right as often as they state, and classes whose names are chance have
//!    the same tables.
//! 4. Floors: below what mean log-likelihood a decision is "unknown".
//! 5. A report: what the rule does with trials that its tables have not seen.
//!
//! What has not been seen is a *fold*: with several recordings of each class a
//! recording is left out, otherwise a trial of each class; of a class's only trial
//! each half in turn.

mod axes;
mod blocks;
mod first_names;
mod floors;
mod model;
mod pieces;
mod report;
mod run;
mod streamed;
mod tables;
#[cfg(test)]
mod tests;
mod trial;
mod warnings;
mod weights;

use std::vec::Vec;

use super::opinion::poses::Poses;
use super::opinion::{self, Material};
use super::{check_names, class_of};
use crate::train_error::TrainError;
use blocks::Blocks;
pub use floors::Floor;
pub use model::JointModel;
use pieces::{Folded, Piece};
use report::THRESHOLD;
pub use report::{AtThreshold, ClassReport, PoseReport, Report};
use run::{Rule, felt, of_unknown};
pub use tables::LogTable;
use tables::{Evidence, Tables, unite};
pub use trial::{CHANNELS, Options, Trial};
pub use warnings::{CHANCE, Warning};
use warnings::{Doubts, MISTAKEN};
pub use weights::MAX_WEIGHT;
use weights::{Known, Prior};

/// Weights of the rule. Floors and they ask for each other: weights are fitted to all stretches,
/// then to those that the floors let pass.
fn fit(rule: &mut Rule, folded: &Folded<'_>, evidence: &[Evidence]) {
    let classes = evidence.first().map_or(0, |piece| piece.classes);
    let lengths = weights::lengths(folded, classes);
    let prior = Some(Prior::TEXTURES);
    rule.weights = weights::fitted(evidence, &lengths, prior, None);
    let floors = &floors_of(rule, folded, evidence);
    let known = Some(Known { rule, floors });
    rule.weights = weights::fitted(evidence, &lengths, prior, known);
}

/// Floors that go with the weights of a rule.
fn floors_of(rule: &Rule, folded: &Folded<'_>, evidence: &[Evidence]) -> Vec<Floor> {
    let pieces = &folded.pieces;
    let classes = evidence.first().map_or(0, |piece| piece.classes);
    let unknown = |class| of_unknown(class, pieces, evidence, rule);
    let unknown: Vec<_> = (0..classes).map(unknown).collect();
    let felt = felt(pieces, evidence, rule);
    floors::of(&felt, classes, floors::REFUSED, &unknown)
}

/// Trains from trials in the order in which they were felt.
///
/// # Errors
/// An option, a name or a sample that is unusable, fewer than two classes, or a
/// class that was not felt for two blocks.
pub fn train(trials: &[Trial], options: &Options) -> Result<JointModel, TrainError> {
    let mut model = once(trials, options)?;
    if model.opinion.is_some() {
        streamed::report(&mut model, trials)?;
    }
    model.report.doubt();
    Ok(model)
}

/// The same, whose report is of the tables and floors alone.
fn once(trials: &[Trial], options: &Options) -> Result<JointModel, TrainError> {
    options.check()?;
    let mut names = Vec::new();
    let classes = trials
        .iter()
        .map(|trial| class_of(&mut names, &trial.label));
    let classes: Vec<usize> = classes.collect::<Result<_, _>>()?;
    check_names(&names)?;
    let scales = blocks::scales(trials)?;
    let mut pieces = Vec::new();
    for (trial, class) in trials.iter().zip(&classes) {
        let blocks = Blocks::of(trial, &scales, options);
        if blocks.len() > 0 {
            pieces.push(Piece {
                class: *class,
                recording: &trial.recording,
                // Numbered once all are known.
                fold: 0,
                blocks,
            });
        }
    }
    let folded = Folded::new(pieces, &names)?;
    let pieces = &folded.pieces;

    let shapes = axes::shapes(pieces, options.bins, options.block);
    let tables = Tables::count(shapes, pieces, names.len(), options.smooth);
    let mut evidence = tables.held_out(pieces);
    let mut rule = Rule {
        threshold: THRESHOLD,
        block: options.block,
        weights: Vec::new(),
        unknown: None,
        apart: false,
    };
    fit(&mut rule, &folded, &evidence);
    let poses = Poses::of(trials);
    let doubts = Doubts {
        names: &names,
        trials,
        folded: &folded,
        evidence: &evidence,
        weights: &rule.weights,
    };
    let (opinion, scarce) = opinion::train(&Material {
        trials,
        classes: &classes,
        names: &names,
        scales: &scales,
        block: options.block,
        expect: options.expect,
        whisked: options.whisked,
        poses: &poses,
        alike: &doubts.groups(MISTAKEN),
    });
    let mut warnings = doubts.warnings();
    warnings.extend(scarce);
    let groups = doubts.groups(CHANCE);
    let mut tables = tables.finished();
    if opinion.is_none() {
        // Nothing else objects to a name.
        for piece in &mut evidence {
            unite(&mut piece.means, &groups);
        }
        for table in &mut tables {
            unite(&mut table.log2_p, &groups);
        }
    }
    let floors = |rule: &Rule| floors_of(rule, &folded, &evidence);
    if opinion.is_none() {
        rule.weights = first_names::lowered(&rule, pieces, &evidence, floors);
    }
    let floors = floors(&rule);
    if opinion.as_ref().is_some_and(|opinion| opinion.names) {
        // Poses of one recording are held out as recordings are.
        warnings.retain(|warning| *warning != Warning::OneRecording);
    }
    let report = report::Maker {
        names: &names,
        trials,
        folded: &folded,
        evidence: &evidence,
        floors: &floors,
        warnings,
    }
    .report(&rule);
    Ok(JointModel {
        poses: poses.count(),
        tables,
        opinion,
        options: options.clone(),
        names,
        scales,
        weights: rule.weights,
        floors,
        report,
    })
}
