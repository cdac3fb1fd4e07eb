//! What a user has to know before trusting a model.

use std::string::String;
use std::vec::Vec;

use super::pieces::Folded;
use super::tables::Evidence;
use super::trial::Trial;
use super::weights::{MAX_WEIGHT, sums};
use crate::score::Interval;

/// Trials of a class below which a warning is due.
const FEW_TRIALS: usize = 3;
/// Lengths of stretches, blocks, by which classes are compared: the longest that there are.
const COMPARED: [usize; 4] = [32, 16, 8, 4];
/// Share of those that may be taken for another class before two cannot be distinguished.
pub(super) const MISTAKEN: f64 = 0.25;
/// The share of those from which on tables that decide alone name neither: their names are chance.
pub const CHANCE: f64 = 0.4;

/// What a user has to know before trusting the model.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the names of fields say it")]
pub enum Warning {
    /// So few trials of a class that its figures are worth little.
    FewTrials { name: String, trials: usize },
    /// Trials that were too short for a block.
    Empty { name: String, trials: usize },
    /// The only trial of a class was cut in halves.
    Halved { name: String },
    /// All is of one recording: what the report says of another one is unknown.
    OneRecording,
    /// Not every class is in several recordings: trials were held out, not recordings.
    NotAcrossRecordings,
    /// A pose, of several, with so few touches of a class that it does not count as one.
    Pose {
        pose: String,
        name: String,
        touches: usize,
        least: usize,
    },
    /// So few touches of a class that there is no second opinion.
    NoOpinion {
        name: String,
        touches: usize,
        least: usize,
    },
    /// So little of a class that no poses are estimated.
    NoPose {
        name: String,
        what: &'static str,
        found: usize,
        least: usize,
    },
    /// A tilt or depth too large to be said in hundredths: no poses are estimated.
    WidePose { found: f64, most: f64 },
    /// Two classes are taken for one another.
    Alike { names: [String; 2], mistaken: f64 },
    /// What decisions state lies above the 95 % interval of those that were right.
    Overstated { stated: f64, found: Interval },
    /// A table's weight is zero, or the most there is.
    Weight { table: usize, weight: f64 },
}

pub(super) struct Doubts<'a> {
    pub(super) names: &'a [String],
    pub(super) trials: &'a [Trial],
    pub(super) folded: &'a Folded<'a>,
    pub(super) evidence: &'a [Evidence],
    pub(super) weights: &'a [f64],
}

impl Doubts<'_> {
    pub(super) fn warnings(&self) -> Vec<Warning> {
        let mut warnings = Vec::new();
        for (class, name) in self.names.iter().enumerate() {
            let pieces = self
                .folded
                .pieces
                .iter()
                .filter(|piece| piece.class == class);
            let halved = self.folded.halved.contains(&class);
            let felt = if halved { 1 } else { pieces.count() };
            let trials = self
                .trials
                .iter()
                .filter(|trial| trial.label == *name)
                .count();
            if felt < FEW_TRIALS {
                warnings.push(Warning::FewTrials {
                    name: name.clone(),
                    trials: felt,
                });
            }
            if felt < trials {
                warnings.push(Warning::Empty {
                    name: name.clone(),
                    trials: trials - felt,
                });
            }
            if halved {
                warnings.push(Warning::Halved { name: name.clone() });
            }
        }
        let first = &self.trials[0].recording;
        if self.trials.iter().all(|trial| trial.recording == *first) {
            warnings.push(Warning::OneRecording);
        } else if !self.folded.by_recording {
            warnings.push(Warning::NotAcrossRecordings);
        }
        let weighty = self.weights.iter().enumerate();
        warnings.extend(
            weighty
                .filter(|&(_, &weight)| weight <= 0.0 || weight >= MAX_WEIGHT)
                .map(|(table, &weight)| Warning::Weight { table, weight }),
        );
        warnings.extend(self.alike().map(|(pair, mistaken)| Warning::Alike {
            names: pair.map(|class| self.names[class].clone()),
            mistaken,
        }));
        warnings
    }

    /// Of each class the first one from which it cannot be distinguished, itself if there is none,
    /// of pairs that are taken for one another more often than this.
    pub(super) fn groups(&self, mistaken: f64) -> Vec<usize> {
        let pairs = self.alike().filter(|(_, of)| *of > mistaken);
        joined(pairs.map(|(pair, _)| pair), self.names.len())
    }

    /// Pairs that cannot be distinguished, and how often one is taken for the other.
    fn alike(&self) -> impl Iterator<Item = ([usize; 2], f64)> {
        let pairs = (0..self.names.len()).flat_map(|a| (0..a).map(move |b| [b, a]));
        pairs
            .map(|[b, a]| {
                let mistaken = f64::midpoint(self.mistaken(a, b), self.mistaken(b, a));
                ([b, a], mistaken)
            })
            .filter(|(_, mistaken)| *mistaken > MISTAKEN)
    }

    /// Share of the longest stretches of a class in which another one's evidence is
    /// larger; where both are the same, half.
    fn mistaken(&self, class: usize, other: usize) -> f64 {
        for length in COMPARED {
            let (mut lost, mut all) = (0.0, 0_u32);
            for piece in self.evidence.iter().filter(|piece| piece.class == class) {
                for stretch in sums(piece, length) {
                    let rows = stretch.chunks_exact(piece.classes).zip(self.weights);
                    let ahead: f64 = rows.map(|(sums, w)| w * (sums[class] - sums[other])).sum();
                    // A tie is lost as often as it is won.
                    lost += match ahead {
                        ahead if ahead > 0.0 => 0.0,
                        ahead if ahead < 0.0 => 1.0,
                        _ => 0.5,
                    };
                    all += 1;
                }
            }
            if all > 0 {
                return lost / f64::from(all);
            }
        }
        0.0
    }
}

/// Of each of so many classes the first one of its group: those of a pair are of one.
fn joined(pairs: impl Iterator<Item = [usize; 2]>, classes: usize) -> Vec<usize> {
    let mut first: Vec<usize> = (0..classes).collect();
    for pair in pairs {
        let of_pair = pair.map(|class| first[class]);
        let least = of_pair[0].min(of_pair[1]);
        for of in first.iter_mut().filter(|of| of_pair.contains(of)) {
            *of = least;
        }
    }
    first
}

#[cfg(test)]
mod tests {
    use super::joined;

    #[test]
    fn what_is_like_a_third_is_of_one_group() {
        let of = |pairs: &[[usize; 2]]| joined(pairs.iter().copied(), 5);
        assert_eq!(of(&[]), [0, 1, 2, 3, 4]);
        assert_eq!(of(&[[1, 3]]), [0, 1, 2, 1, 4]);
        // In any order.
        assert_eq!(of(&[[2, 3], [1, 3], [0, 4]]), [0, 1, 1, 1, 0]);
        assert_eq!(of(&[[3, 4], [0, 1], [1, 4]]), [0, 0, 2, 0, 0]);
    }
}
