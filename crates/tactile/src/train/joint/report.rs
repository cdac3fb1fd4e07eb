//! What the rule does with trials that its tables have not seen.

use std::string::String;
use std::vec;
use std::vec::Vec;

use super::floors::Floor;
use super::pieces::Folded;
use super::run::{Decided, Rule, decisions, of_unknown};
use super::tables::Evidence;
use super::trial::Trial;
use super::warnings::Warning;
use crate::score::Interval;

/// Thresholds at which the rule is tried.
const THRESHOLDS: [f64; 7] = [0.8, 0.9, 0.95, 0.98, 0.99, 0.995, 0.999];

/// What was found of a class.
#[derive(Debug, Clone, PartialEq)]
pub struct ClassReport {
    /// Its name.
    pub name: String,
    /// Trials of it.
    pub trials: usize,
    /// Trials (or halves of one) in which nothing was decided, "unknown" among it.
    pub undecided: usize,
    /// Decisions that named a class, by the class named.
    pub named: Vec<usize>,
    /// Decisions that said "unknown".
    pub unknown: usize,
    /// Of the decisions that named a class, those that were right.
    pub hits: Interval,
    /// Of the decisions for this class before the floors that were right, those refused.
    pub refused: Interval,
    /// Were it not among the classes: of the decisions on its trials, those that said
    /// "unknown". By the floors of the others, which were learnt beside it.
    pub noticed: Interval,
    /// Mean samples of a decision.
    pub samples: f64,
}

/// Stated and found at a threshold, over the decisions that named a class.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AtThreshold {
    /// The threshold.
    pub threshold: f64,
    /// Mean posterior of the decisions.
    pub stated: f64,
    /// Share of them that was right.
    pub found: Interval,
    /// Mean samples of a decision.
    pub samples: f64,
    /// Share of decisions that said "unknown".
    pub unknown: Interval,
    /// Share of trials without a decision.
    pub undecided: Interval,
}

/// What was found of a pose when it was held out.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseReport {
    /// What it is called.
    pub name: String,
    /// Share of its trials in which a class was named.
    pub decided: Interval,
    /// Of the decisions that named a class, those that were right.
    pub hits: Interval,
    /// `decided` of each class.
    pub classes: Vec<Interval>,
}

/// What held-out trials say of a model.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// The threshold of the figures by class.
    pub threshold: f64,
    /// Each class.
    pub classes: Vec<ClassReport>,
    /// Stated against found, at thresholds in rising order.
    pub calibration: Vec<AtThreshold>,
    /// Each pose, where poses were held out and have names; otherwise none.
    pub poses: Vec<PoseReport>,
    /// What is doubtful.
    pub warnings: Vec<Warning>,
}

pub(super) struct Maker<'a> {
    pub(super) names: &'a [String],
    pub(super) trials: &'a [Trial],
    pub(super) folded: &'a Folded<'a>,
    pub(super) evidence: &'a [Evidence],
    pub(super) floors: Option<&'a [Floor]>,
    pub(super) warnings: Vec<Warning>,
}

impl Maker<'_> {
    pub(super) fn report(self, rule: &Rule) -> Report {
        let threshold = rule.threshold;
        let run = |threshold| {
            let rule = Rule {
                threshold,
                ..rule.clone()
            };
            decisions(&self.folded.pieces, self.evidence, &rule)
        };
        let calibration = THRESHOLDS.map(|threshold| self.at(threshold, &run(threshold)));
        let found = run(threshold);
        Report {
            threshold,
            classes: (0..self.names.len())
                .map(|class| self.class(class, &found, rule))
                .collect(),
            calibration: calibration.to_vec(),
            poses: Vec::new(),
            warnings: self.warnings,
        }
    }

    fn refused(&self, decided: &Decided) -> bool {
        let floor = self.floors.and_then(|floors| floors.get(decided.class));
        floor.is_some_and(|floor| floor.refuses(decided.entries))
    }

    fn undecided(&self, found: &[Decided], class: Option<usize>) -> Interval {
        let of = |n: usize| class.is_none_or(|class| self.folded.pieces[n].class == class);
        let mut silent = vec![true; self.folded.pieces.len()];
        for decided in found.iter().filter(|d| !self.refused(d)) {
            silent[decided.piece] = false;
        }
        let all = (0..silent.len()).filter(|&n| of(n));
        Interval::of(all.clone().filter(|&n| silent[n]).count(), all.count())
    }

    fn at(&self, threshold: f64, found: &[Decided]) -> AtThreshold {
        let named = || found.iter().filter(|d| !self.refused(d));
        let count = named().count();
        AtThreshold {
            threshold,
            stated: named().map(|d| d.posterior).sum::<f64>() / count as f64,
            found: Interval::of(named().filter(|d| d.class == d.truth).count(), count),
            samples: named().map(|d| f64::from(d.samples)).sum::<f64>() / count as f64,
            unknown: Interval::of(found.len() - count, found.len()),
            undecided: self.undecided(found, None),
        }
    }

    fn class(&self, class: usize, found: &[Decided], rule: &Rule) -> ClassReport {
        let of_class = || found.iter().filter(|d| d.truth == class);
        let right = || of_class().filter(|d| d.class == class);
        let mut named = vec![0; self.names.len()];
        let mut samples = 0.0;
        for decided in of_class().filter(|d| !self.refused(d)) {
            named[decided.class] += 1;
            samples += f64::from(decided.samples);
        }
        let count: usize = named.iter().sum();
        ClassReport {
            name: self.names[class].clone(),
            trials: self.trials_of(class).count(),
            undecided: {
                let Interval { share, count, .. } = self.undecided(found, Some(class));
                (share * count as f64).round() as usize
            },
            unknown: of_class().count() - count,
            hits: Interval::of(named[class], count),
            refused: Interval::of(right().filter(|d| self.refused(d)).count(), right().count()),
            noticed: {
                let found = of_unknown(class, &self.folded.pieces, self.evidence, rule);
                let noticed = found.iter().filter(|d| self.refused(d)).count();
                Interval::of(noticed, found.len())
            },
            samples: samples / count as f64,
            named,
        }
    }

    fn trials_of(&self, class: usize) -> impl Iterator<Item = &Trial> {
        self.trials
            .iter()
            .filter(move |trial| trial.label == self.names[class])
    }
}
