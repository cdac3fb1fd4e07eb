//! Training the joint model from labelled trials: tables, weights, floors and a
//! report, in double precision.
//!
//! 1. Blocks: what the module will see of a trial: blocks of counted
//!    samples in order, dropped at the onset of a touch, and their roughness.
//! 2. Tables: per class a joint histogram over the 0.2 to 99.8 % quantiles of both
//!    channels, smoothed; one of samples, one of the roughness of blocks.
//! 3. Weights: samples, and tables, are not independent. Evidence of a block =
//!    Σ wₜ · mean of log₂ p of table t; the w ≥ 0 minimise the log loss over
//!    stretches of blocks that their tables have not seen.
//! 4. Floors: below what mean log-likelihood a decision is "unknown".
//! 5. A report: what the rule does with trials that its tables have not seen.
//!
//! What has not been seen is a *fold*: with several recordings of each class a
//! recording is left out, otherwise a trial of each class; of a class's only trial
//! each half in turn.

mod blocks;
mod floors;
mod pieces;
mod report;
mod run;
mod tables;
#[cfg(test)]
mod tests;
mod trial;
mod weights;

use std::string::String;
use std::vec::Vec;

use crate::train_error::TrainError;
use blocks::Blocks;
pub use floors::Floor;
use pieces::{Piece, folded, names};
pub use report::{AtThreshold, ClassReport, Interval, Report, Warning};
use run::{Rule, decisions};
use tables::{Axes, Layout, Tables};
pub use tables::{Axis, LogTable, TableSource};
pub use trial::{CHANNELS, Options, Trial};
pub use weights::MAX_WEIGHT;

/// What training gives.
#[derive(Debug, Clone, PartialEq)]
pub struct JointModel {
    /// Class names, as they first appear.
    pub names: Vec<String>,
    /// Tables of log-likelihoods, not yet weighted.
    pub tables: Vec<LogTable>,
    /// Weight of each table, 0 to [`MAX_WEIGHT`].
    pub weights: Vec<f64>,
    /// A floor a class; none where none was wanted.
    pub floors: Option<Vec<Floor>>,
    /// What held-out trials say of all this.
    pub report: Report,
}

/// Trains from trials in the order in which they were felt.
///
/// # Errors
///
/// An option, a name or a sample that is unusable, fewer than two classes, or a
/// class that was not felt for two blocks.
pub fn train(trials: &[Trial], options: &Options) -> Result<JointModel, TrainError> {
    options.check()?;
    let names = names(trials)?;
    let scales = blocks::scales(trials)?;
    let mut pieces = Vec::new();
    for trial in trials {
        let class = names.iter().position(|name| *name == trial.label);
        let blocks = Blocks::of(trial, &scales, options);
        if blocks.len() > 0 {
            pieces.push(Piece {
                class: class.unwrap_or_default(),
                recording: &trial.recording,
                // Numbered once all are known.
                fold: 0,
                blocks,
            });
        }
    }
    let (pieces, halved) = folded(pieces, &names)?;

    let axes = Axes::of(&pieces, scales, options.bins)?;
    let layout = Layout::joint(&axes, options.block);
    let tables = Tables::count(&layout, &pieces, names.len(), options.smooth);
    let evidence = tables.held_out(&pieces);
    let weights = weights::fitted(&evidence);

    let rule = |threshold| Rule {
        threshold,
        limit_bits: options.limit_bits,
        block: options.block,
        weights: &weights,
        sources: layout.sources(),
    };
    let found = decisions(&pieces, &evidence, &rule(options.threshold));
    let floors = (options.refused > 0.0).then(|| floors::of(&found, names.len(), options.refused));
    let report = report::Maker {
        names: &names,
        trials,
        pieces: &pieces,
        halved: &halved,
        evidence: &evidence,
        floors: floors.as_deref(),
    }
    .report(&weights, options.threshold, rule);
    Ok(JointModel {
        tables: tables.finished(),
        names,
        weights,
        floors,
        report,
    })
}
