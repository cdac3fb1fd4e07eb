//! Weights by which the first name of a trial is right as often as it says.
//!
//! Weights are fitted to stretches from anywhere in a trial. But a trial has a character of its own:
//! where its class looks like another for long, the wrong name comes first. So all weights are
//! lowered until the first names of trials that were held out are right as often as they state,
//! which takes more time to decide.

use std::vec::Vec;

use statrs::distribution::{DiscreteCDF, Poisson};

use super::floors::Floor;
use super::pieces::Piece;
use super::run::{Decided, Rule, decisions};
use super::tables::Evidence;

/// By what all weights are multiplied, in twentieths; the largest that holds is taken.
const TWENTIETHS: core::ops::RangeInclusive<u32> = 1..=20;
/// Thresholds at which names are wrong often enough for a few trials to show it.
const LOWER: [f64; 2] = [0.8, 0.9];
/// So rarely are as many wrong of what is right as often as it states.
const RARE: f64 = 0.05;

/// Whether first names of trials may be right as often as they state: of so many the number of wrong
/// ones is Poisson's.
fn keep(mut names: Vec<Decided>) -> bool {
    names.dedup_by_key(|name| name.piece);
    let wrong = names.iter().filter(|name| !name.is_right()).count() as u64;
    let expected: f64 = names.iter().map(|name| 1.0 - name.posterior).sum();
    // None where nothing is expected to be wrong.
    let as_many = Poisson::new(expected).map(|wrongs| wrongs.sf(wrong.saturating_sub(1)));
    wrong == 0 || as_many.is_ok_and(|probability| probability >= RARE)
}

/// The weights of `rule`, lowered until first names keep what they state at its threshold and at
/// lower ones.
pub(super) fn lowered(
    rule: &Rule,
    pieces: &[Piece<'_>],
    evidence: &[Evidence],
    floors: impl Fn(&Rule) -> Vec<Floor>,
) -> Vec<f64> {
    let mut lower = Rule {
        apart: true,
        ..rule.clone()
    };
    for twentieths in TWENTIETHS.rev() {
        let factor = f64::from(twentieths) / 20.0;
        lower.weights = rule.weights.iter().map(|weight| factor * weight).collect();
        let floors = floors(&lower);
        let is_kept = |threshold: f64| {
            let rule = Rule {
                threshold,
                ..lower.clone()
            };
            let mut names = decisions(pieces, evidence, &rule);
            names.retain(|decided| {
                let floor = floors.get(decided.class);
                floor.is_none_or(|floor| !floor.refuses(decided.entries))
            });
            keep(names)
        };
        if is_kept(rule.threshold) && LOWER.into_iter().all(is_kept) {
            break;
        }
    }
    lower.weights
}
