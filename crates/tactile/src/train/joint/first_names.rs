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
const TWENTIETHS: core::ops::RangeInclusive<u32> = 4..=20;

/// The weights of `rule`, lowered until what first names state is not above the 95 % interval of
/// the share that is right; the least that are tried if it always is.
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
        let is_named = |decided: &Decided| {
            let floor = floors.as_ref().and_then(|floors| floors.get(decided.class));
            floor.is_none_or(|floor| !floor.refuses(decided.entries))
        };
        let mut names = decisions(pieces, evidence, &lower);
        names.retain(is_named);
        names.dedup_by_key(|name| name.piece);
        let right = names.iter().filter(|name| name.class == name.truth).count();
        let stated: f64 = names.iter().map(|name| name.posterior).sum();
        let count = names.len();
        if stated <= Interval::of(right, count).high * count as f64 {
            break;
        }
    }
    lower.weights
}
