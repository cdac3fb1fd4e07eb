//! Below what mean entry a decision is "unknown": none of the classes looks like this.
//!
//! What a class's entries are at a decision differs within a trial, and from one trial to
//! another. A floor is the lower prediction bound for a decision in another trial: with the
//! mean m over trials, the variance w within and b between them, and n trials it is
//! m − t √(b (1 + 1/n) + w), t of Student's distribution with Satterthwaite's degrees of freedom.
//!
//! The share to be refused is split between the tables of samples and those of roughness.
//! Which of them tells a texture that was not trained differs; so each class in turn is
//! taken for such a one, and the split that refuses most of their decisions is taken.

use std::vec::Vec;

use statrs::distribution::{ContinuousCDF, StudentsT};

use super::run::{Decided, Felt};

/// Shares of what is refused that may fall to the tables of samples; an even one first,
/// which is taken if no other is better.
const SPLITS: [f64; 5] = [0.5, 0.25, 0.75, 0.0, 1.0];

/// Share of decisions that the floors may refuse of what they were learnt from. Of other recordings
/// they refuse more: where a scene's one run was trained on, 1 % became 3 % of textures and 6 % of
/// the elastic whisker.
pub(super) const REFUSED: f64 = 0.01;

/// The least mean entries, since the onset of the touch, of a class that is known; bits
/// times weight, with the offset of 20 bit.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Floor {
    /// Of the tables of samples.
    pub samples: f64,
    /// Of the tables of roughness.
    pub roughness: f64,
}

impl Floor {
    pub(super) fn refuses(&self, [samples, roughness]: [f64; 2]) -> bool {
        samples < self.samples || roughness < self.roughness
    }
}

/// Floors that refuse a share of what is felt of the classes; `unknown` is what was decided
/// on classes that the rule did not know, class after class.
pub(super) fn of(
    felt: &[Felt],
    classes: usize,
    refused: f64,
    unknown: &[Vec<Decided>],
) -> Vec<Floor> {
    let spreads: Vec<[Option<Spread>; 2]> = (0..classes)
        .map(|class| [0, 1].map(|source| Spread::of(felt, class, source)))
        .collect();
    let mut best: Option<(f64, Vec<Floor>)> = None;
    for split in SPLITS {
        let shares = [split * refused, (1.0 - split) * refused];
        let floors: Vec<Floor> = spreads.iter().map(|spread| floor(spread, shares)).collect();
        let noticed = unknown
            .iter()
            .map(|decided| share_refused(decided, &floors))
            .sum();
        if best.as_ref().is_none_or(|(most, _)| noticed > *most) {
            best = Some((noticed, floors));
        }
    }
    best.map_or_else(Vec::new, |(_, floors)| floors)
}

fn floor(spread: &[Option<Spread>; 2], shares: [f64; 2]) -> Floor {
    let bound = |source: usize| {
        let spread = spread[source].as_ref()?;
        (shares[source] > 0.0).then(|| spread.bound(shares[source]).max(0.0))
    };
    Floor {
        samples: bound(0).unwrap_or(0.0),
        roughness: bound(1).unwrap_or(0.0),
    }
}

fn share_refused(decided: &[Decided], floors: &[Floor]) -> f64 {
    let refused = decided
        .iter()
        .filter(|d| floors[d.class].refuses(d.entries));
    refused.count() as f64 / decided.len().max(1) as f64
}

/// How the entries of a class differ, within trials and between them.
struct Spread {
    mean: f64,
    variance: f64,
    freedom: f64,
}

impl Spread {
    /// Of a class; none of fewer than two trials, or where nothing differs.
    fn of(felt: &[Felt], class: usize, source: usize) -> Option<Self> {
        let own: Vec<&Felt> = felt.iter().filter(|felt| felt.class == class).collect();
        let trials: Vec<Vec<f64>> = own
            .chunk_by(|a, b| a.piece == b.piece)
            .map(|trial| trial.iter().map(|felt| felt.entries[source]).collect())
            .collect();
        if trials.len() < 2 {
            return None;
        }
        let n = trials.len() as f64;
        let count = own.len() as f64;
        let means: Vec<f64> = trials.iter().map(|trial| mean(trial)).collect();
        let overall = mean(&means);
        let squares = |values: &[f64], about: f64| -> f64 {
            values.iter().map(|x| (x - about) * (x - about)).sum()
        };
        // Without two of any trial the variance of the means holds all.
        let within_freedom = (count - n).max(1.0);
        let within: f64 = trials
            .iter()
            .zip(&means)
            .map(|(trial, mean)| squares(trial, *mean))
            .sum::<f64>()
            / within_freedom;
        let of_means = squares(&means, overall) / (n - 1.0);
        let share_within = trials
            .iter()
            .map(|trial| within / trial.len() as f64)
            .sum::<f64>()
            / n;
        let between = (of_means - share_within).max(0.0) * (1.0 + 1.0 / n);
        let variance = between + within;
        let freedom = variance * variance
            / (between * between / (n - 1.0) + within * within / within_freedom);
        freedom.is_finite().then_some(Self {
            mean: overall,
            variance,
            freedom,
        })
    }

    /// Below which a share of decisions in another trial lies.
    fn bound(&self, share: f64) -> f64 {
        let student = StudentsT::new(0.0, 1.0, self.freedom);
        student.map_or(0.0, |student| {
            self.mean + student.inverse_cdf(share) * self.variance.sqrt()
        })
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}
