//! What the rule does with trials that its tables have not seen.

use std::string::String;
use std::vec::Vec;

use super::floors::Floor;
use super::pieces::Folded;
use super::run::{Decided, Rule, decisions, of_unknown};
use super::tables::Evidence;
use super::trial::Trial;
use super::warnings::Warning;
use crate::score::Interval;

/// Thresholds at which the rule is tried.
const THRESHOLDS: [f64; 7] = [0.8, 0.9, 0.95, 0.98, THRESHOLD, 0.995, 0.999];
/// The one at which floors and the figures of classes let it decide, and which of them it is.
pub(super) const THRESHOLD: f64 = 0.99;
pub(super) const USUAL: usize = 4;

/// What was found of a class.
#[derive(Debug, Clone, PartialEq)]
pub struct ClassReport {
    /// Its name.
    pub name: String,
    /// Trials of it.
    pub trials: usize,
    /// Trials (or halves of one) that were held out, and in how many of them nothing was
    /// decided, "unknown" among it.
    pub parts: usize,
    /// See `parts`.
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

impl Report {
    /// Warns where decisions at the threshold state more than they keep.
    pub(super) fn doubt(&mut self) {
        let own = self.calibration.get(USUAL);
        let own = own.filter(|at| at.stated > at.found.high);
        let doubts = own.map(|at| Warning::Overstated {
            stated: at.stated,
            found: at.found,
        });
        self.warnings.extend(doubts);
    }
}

/// In how many parts no class was named, and of how many.
pub(super) fn silent(said: &[Decided], parts: impl Iterator<Item = usize>) -> [usize; 2] {
    let is_decided = |part: usize| said.iter().any(|said| said.piece == part && said.is_named);
    parts.fold([0; 2], |[silent, count], part| {
        [silent + usize::from(!is_decided(part)), count + 1]
    })
}

impl AtThreshold {
    pub(super) fn of(threshold: f64, said: &[Decided], parts: usize) -> Self {
        let named = || said.iter().filter(|said| said.is_named);
        let count = named().count();
        let [undecided, parts] = silent(said, 0..parts);
        let mean = |of: &dyn Fn(&Decided) -> f64| named().map(of).sum::<f64>() / count as f64;
        Self {
            threshold,
            stated: mean(&|said| said.posterior),
            found: Interval::of(named().filter(|said| said.is_right()).count(), count),
            samples: mean(&|said| f64::from(said.samples)),
            unknown: Interval::of(said.len() - count, said.len()),
            undecided: Interval::of(undecided, parts),
        }
    }
}

impl ClassReport {
    /// `parts`: those of the class.
    pub(super) fn of(
        class: usize,
        names: &[String],
        trials: &[Trial],
        noticed: Interval,
        said: &[Decided],
        parts: impl Iterator<Item = usize>,
    ) -> Self {
        let of = || said.iter().filter(|said| said.truth == class);
        let named = || of().filter(|said| said.is_named);
        let count = named().count();
        let right = of().filter(|said| said.is_right()).count();
        let right_named = named().filter(|said| said.is_right()).count();
        let as_other = |n| named().filter(|said| said.class == n).count();
        let samples = named().map(|said| f64::from(said.samples));
        let [undecided, parts] = silent(said, parts);
        let own = trials.iter().filter(|trial| trial.label == names[class]);
        Self {
            name: names[class].clone(),
            trials: own.count(),
            parts,
            undecided,
            named: (0..names.len()).map(as_other).collect(),
            unknown: of().count() - count,
            hits: Interval::of(right_named, count),
            refused: Interval::of(right - right_named, right),
            noticed,
            samples: samples.sum::<f64>() / count as f64,
        }
    }
}

pub(super) struct Maker<'a> {
    pub(super) names: &'a [String],
    pub(super) trials: &'a [Trial],
    pub(super) folded: &'a Folded<'a>,
    pub(super) evidence: &'a [Evidence],
    pub(super) floors: &'a [Floor],
    pub(super) warnings: Vec<Warning>,
}

impl Maker<'_> {
    pub(super) fn report(self, rule: &Rule) -> Report {
        let said = THRESHOLDS.map(|threshold| self.said(rule, threshold));
        let class = |class| self.class(class, &said[USUAL], rule);
        let calibration = THRESHOLDS.iter().zip(&said);
        let parts = self.folded.pieces.len();
        Report {
            threshold: THRESHOLD,
            classes: (0..self.names.len()).map(class).collect(),
            calibration: calibration
                .map(|(at, said)| AtThreshold::of(*at, said, parts))
                .collect(),
            poses: Vec::new(),
            warnings: self.warnings,
        }
    }

    fn said(&self, rule: &Rule, threshold: f64) -> Vec<Decided> {
        let rule = Rule {
            threshold,
            apart: true,
            ..rule.clone()
        };
        let mut said = decisions(&self.folded.pieces, self.evidence, &rule);
        for said in &mut said {
            said.is_named = !self.refused(said);
        }
        said
    }

    fn refused(&self, decided: &Decided) -> bool {
        let floor = self.floors.get(decided.class);
        floor.is_some_and(|floor| floor.refuses(decided.entries))
    }

    fn class(&self, class: usize, said: &[Decided], rule: &Rule) -> ClassReport {
        let pieces = &self.folded.pieces;
        let found = of_unknown(class, pieces, self.evidence, rule);
        let noticed = found.iter().filter(|decided| self.refused(decided)).count();
        let noticed = Interval::of(noticed, found.len());
        let own = (0..pieces.len()).filter(|part| pieces[*part].class == class);
        ClassReport::of(class, self.names, self.trials, noticed, said, own)
    }
}
