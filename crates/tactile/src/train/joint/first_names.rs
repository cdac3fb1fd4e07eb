//! Weights by which the first name of a trial is right as often as it says.
//!
//! Weights are fitted to stretches from anywhere in a trial. But a trial has a character of its own:
//! where its class looks like another for long, the wrong name comes first. So all weights are
//! lowered until the first names of trials that were held out are right as often as they state,
//! which takes more time to decide.

use std::vec::Vec;

use super::floors::Floor;
use super::pieces::Piece;
use super::run::{Decided, Rule, decisions};
use super::tables::Evidence;
use crate::score::Interval;

/// By what all weights are multiplied, in twentieths; the largest that holds is taken.
const TWENTIETHS: core::ops::RangeInclusive<u32> = 1..=20;
/// Thresholds at which names are wrong often enough for a few trials to show it.
const LOWER: [f64; 2] = [0.8, 0.9];

/// First names of trials.
struct Named {
    count: usize,
    right: usize,
    /// The sum of what they state.
    stated: f64,
}

impl Named {
    fn of(mut names: Vec<Decided>) -> Self {
        names.dedup_by_key(|name| name.piece);
        let right = names.iter().filter(|name| name.class == name.truth);
        Self {
            count: names.len(),
            right: right.count(),
            stated: names.iter().map(|name| name.posterior).sum(),
        }
    }

    /// Whether as many are right as they state.
    fn keeps(&self) -> bool {
        self.right as f64 >= self.stated.round()
    }

    /// Whether what they state is not above the 95 % interval of those that are right.
    fn may_keep(&self) -> bool {
        self.stated <= Interval::of(self.right, self.count).high * self.count as f64
    }
}

/// The weights of `rule`, lowered until first names keep what they state: at its threshold in whole
/// names, at lower ones as far as so many can show.
pub(super) fn lowered(
    rule: &Rule,
    pieces: &[Piece<'_>],
    evidence: &[Evidence],
    floors: impl Fn(&Rule) -> Option<Vec<Floor>>,
) -> Vec<f64> {
    let mut lower = Rule {
        apart: true,
        ..rule.clone()
    };
    for twentieths in TWENTIETHS.rev() {
        let factor = f64::from(twentieths) / 20.0;
        lower.weights = rule.weights.iter().map(|weight| factor * weight).collect();
        let floors = floors(&lower);
        let named = |threshold: f64| {
            let rule = Rule {
                threshold,
                ..lower.clone()
            };
            let mut names = decisions(pieces, evidence, &rule);
            names.retain(|decided| {
                let floor = floors.as_ref().and_then(|floors| floors.get(decided.class));
                floor.is_none_or(|floor| !floor.refuses(decided.entries))
            });
            Named::of(names)
        };
        if named(rule.threshold).keeps() && LOWER.iter().all(|of| named(*of).may_keep()) {
            break;
        }
    }
    lower.weights
}
