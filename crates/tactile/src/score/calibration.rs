//! What decisions state of themselves against what was found.

use std::vec::Vec;

use super::interval::Interval;
use super::statistics::Statistics;

/// Ends of the bins of posteriors: finer towards one, where thresholds lie.
const EDGES: [f64; 11] = [
    0.0, 0.5, 0.8, 0.9, 0.95, 0.98, 0.99, 0.995, 0.998, 0.999, 0.9999,
];

/// Stated against found, over decisions that named a class.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    /// Mean posterior; not a number without a decision.
    pub stated: f64,
    /// Share that was right.
    pub found: Interval,
    /// The same by posterior, rising; bins without a decision are left out.
    pub bins: Vec<CalibrationBin>,
}

/// Decisions of about the same posterior.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CalibrationBin {
    /// Least posterior of the bin.
    pub low: f64,
    /// Where the next begins.
    pub high: f64,
    /// Mean posterior.
    pub stated: f64,
    /// Share that was right.
    pub found: Interval,
}

impl Calibration {
    /// Of the posterior of each decision, and whether it was right.
    pub fn of(decisions: impl Iterator<Item = (f64, bool)> + Clone) -> Self {
        let bins = EDGES.iter().enumerate().filter_map(|(n, &low)| {
            let high = EDGES.get(n + 1).copied().unwrap_or(1.0);
            let last = n + 1 == EDGES.len();
            let inside = |p: f64| p >= low && (p < high || last);
            let (stated, found) = compare(decisions.clone().filter(|&(p, _)| inside(p)));
            (found.count > 0).then_some(CalibrationBin {
                low,
                high,
                stated,
                found,
            })
        });
        let bins = bins.collect();
        let (stated, found) = compare(decisions);
        Self {
            stated,
            found,
            bins,
        }
    }

    /// The mean over decisions of how far stated and found lie apart in their bin;
    /// not a number without a decision.
    pub fn error(&self) -> f64 {
        let apart = self.bins.iter().map(|bin| {
            let share = bin.found.count as f64 / self.found.count as f64;
            share * (bin.stated - bin.found.share).abs()
        });
        if self.bins.is_empty() {
            f64::NAN
        } else {
            apart.sum()
        }
    }
}

fn compare(decisions: impl Iterator<Item = (f64, bool)> + Clone) -> (f64, Interval) {
    let stated = Statistics::of(decisions.clone().map(|(p, _)| p));
    let right = decisions.clone().filter(|&(_, right)| right).count();
    let found = Interval::of(right, decisions.count());
    (stated.map_or(f64::NAN, |s| s.mean), found)
}
