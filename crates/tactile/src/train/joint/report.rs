//! What the rule does with trials that its tables have not seen.

use std::string::String;
use std::vec;
use std::vec::Vec;

use super::floors::Floor;
use super::pieces::Folded;
use super::run::{Decided, Rule, decisions};
use super::tables::Evidence;
use super::trial::Trial;
use super::weights::{MAX_WEIGHT, sums};

/// Thresholds at which the rule is tried.
const THRESHOLDS: [f64; 7] = [0.8, 0.9, 0.95, 0.98, 0.99, 0.995, 0.999];
/// Trials of a class below which a warning is due.
const FEW_TRIALS: usize = 3;
/// Lengths of stretches, blocks, by which classes are compared: the longest that there are.
const COMPARED: [usize; 4] = [32, 16, 8, 4];
/// Share of those that may be taken for another class before two cannot
/// be told.
const MISTAKEN: f64 = 0.25;

/// A share with its 95 % interval by Wilson. Decisions of one trial are not independent:
/// where there are many a trial, the truth is wider.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// The share found; not a number of nothing.
    pub share: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Of how many.
    pub count: usize,
}

impl Interval {
    /// Of so many of so many.
    pub fn of(part: usize, count: usize) -> Self {
        // The normal quantile of 97.5 %, squared.
        const Z2: f64 = 3.841_458_820_694_124;
        let n = count as f64;
        let share = part as f64 / n;
        if count == 0 {
            let (low, high) = (0.0, 1.0);
            return Self {
                share,
                low,
                high,
                count,
            };
        }
        let middle = (share + Z2 / (2.0 * n)) / (1.0 + Z2 / n);
        let spread = share * (1.0 - share) * Z2 / n + Z2 * Z2 / (4.0 * n * n);
        let half = spread.sqrt() / (1.0 + Z2 / n);
        Self {
            share,
            low: (middle - half).max(0.0),
            high: (middle + half).min(1.0),
            count,
        }
    }
}

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

/// What a user has to know before trusting the model.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// So few trials of a class that its figures are worth little.
    FewTrials {
        /// The class.
        name: String,
        /// How many.
        trials: usize,
    },
    /// Trials that were too short for a block.
    Empty {
        /// The class.
        name: String,
        /// How many.
        trials: usize,
    },
    /// The only trial of a class was cut in halves.
    Halved {
        /// The class.
        name: String,
    },
    /// All is of one recording: what the report says of another one is unknown.
    OneRecording,
    /// Not every class is in several recordings: trials were held out, not recordings.
    NotAcrossRecordings,
    /// Two classes are taken for one another.
    Alike {
        /// Their names.
        names: [String; 2],
        /// Share of the longest stretches that the other class wins.
        mistaken: f64,
    },
    /// A table's weight is zero, or the most there is.
    Weight {
        /// The table.
        table: usize,
        /// Its weight.
        weight: f64,
    },
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
    /// What is doubtful.
    pub warnings: Vec<Warning>,
}

/// What a report is made of.
pub(super) struct Maker<'a> {
    pub(super) names: &'a [String],
    pub(super) trials: &'a [Trial],
    pub(super) folded: &'a Folded<'a>,
    pub(super) evidence: &'a [Evidence],
    pub(super) floors: Option<&'a [Floor]>,
}

impl Maker<'_> {
    /// By the rule at a threshold.
    pub(super) fn report(&self, rule: &Rule) -> Report {
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
                .map(|class| self.class(class, &found))
                .collect(),
            calibration: calibration.to_vec(),
            warnings: self.warnings(&rule.weights),
        }
    }

    fn refused(&self, decided: &Decided) -> bool {
        let floor = self.floors.and_then(|floors| floors.get(decided.class));
        floor.is_some_and(|floor| floor.refuses(decided))
    }

    /// Pieces, of all classes or of one, without a decision that names a class.
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

    fn class(&self, class: usize, found: &[Decided]) -> ClassReport {
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
            samples: samples / count as f64,
            named,
        }
    }

    fn trials_of(&self, class: usize) -> impl Iterator<Item = &Trial> {
        self.trials
            .iter()
            .filter(move |trial| trial.label == self.names[class])
    }

    fn warnings(&self, weights: &[f64]) -> Vec<Warning> {
        let mut warnings = Vec::new();
        for (class, name) in self.names.iter().enumerate() {
            let name = || name.clone();
            let pieces = self
                .folded
                .pieces
                .iter()
                .filter(|piece| piece.class == class)
                .count();
            let halved = self.folded.halved.contains(&class);
            let felt = if halved { 1 } else { pieces };
            let trials = self.trials_of(class).count();
            if felt < FEW_TRIALS {
                warnings.push(Warning::FewTrials {
                    name: name(),
                    trials: felt,
                });
            }
            if felt < trials {
                warnings.push(Warning::Empty {
                    name: name(),
                    trials: trials - felt,
                });
            }
            if halved {
                warnings.push(Warning::Halved { name: name() });
            }
        }
        let first = &self.trials[0].recording;
        if self.trials.iter().all(|trial| trial.recording == *first) {
            warnings.push(Warning::OneRecording);
        } else if !self.folded.by_recording {
            warnings.push(Warning::NotAcrossRecordings);
        }
        let weighty = weights.iter().enumerate();
        warnings.extend(
            weighty
                .filter(|&(_, &weight)| weight <= 0.0 || weight >= MAX_WEIGHT)
                .map(|(table, &weight)| Warning::Weight { table, weight }),
        );
        for a in 0..self.names.len() {
            for b in 0..a {
                let mistaken =
                    f64::midpoint(self.mistaken(weights, a, b), self.mistaken(weights, b, a));
                if mistaken > MISTAKEN {
                    let names = [b, a].map(|class| self.names[class].clone());
                    warnings.push(Warning::Alike { names, mistaken });
                }
            }
        }
        warnings
    }

    /// Share of the longest stretches of a class in which another one's evidence is
    /// larger.
    fn mistaken(&self, weights: &[f64], class: usize, other: usize) -> f64 {
        for length in COMPARED {
            let (mut lost, mut all) = (0_u32, 0_u32);
            for piece in self.evidence.iter().filter(|piece| piece.class == class) {
                for stretch in sums(piece, length) {
                    let rows = stretch.chunks_exact(piece.classes).zip(weights);
                    let ahead: f64 = rows.map(|(sums, w)| w * (sums[class] - sums[other])).sum();
                    lost += u32::from(ahead <= 0.0);
                    all += 1;
                }
            }
            if all > 0 {
                return f64::from(lost) / f64::from(all);
            }
        }
        0.0
    }
}
