//! Below what mean entry a decision is "unknown": none of the classes looks like this.

use std::vec::Vec;

use super::run::Decided;

/// Right decisions that a class needs for floors of its own; with fewer it shares the
/// spread of all classes about their means.
const ENOUGH: usize = 20;

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
    /// Whether a decision lies below.
    pub(super) fn refuses(&self, decided: &Decided) -> bool {
        let [samples, roughness] = decided.entries;
        samples < self.samples || roughness < self.roughness
    }
}

/// Floors that refuse a share of the right decisions.
pub(super) fn of(decided: &[Decided], classes: usize, refused: f64) -> Vec<Floor> {
    let right: Vec<Vec<[f64; 2]>> = (0..classes)
        .map(|class| {
            let right = decided
                .iter()
                .filter(|d| d.truth == class && d.class == class);
            right.map(|d| d.entries).collect()
        })
        .collect();
    let means: Vec<[f64; 2]> = right.iter().map(|entries| mean(entries)).collect();
    let about_means = right.iter().zip(&means).flat_map(|(entries, mean)| {
        let about = |[a, b]: &[f64; 2]| [a - mean[0], b - mean[1]];
        entries.iter().map(about)
    });
    let spread = quantiles(&about_means.collect::<Vec<_>>(), refused);
    right
        .iter()
        .zip(&means)
        .map(|(entries, mean)| {
            let [samples, roughness] = if entries.is_empty() {
                // Never right: nothing says where it lies.
                [0.0; 2]
            } else if entries.len() < ENOUGH {
                [mean[0] + spread[0], mean[1] + spread[1]]
            } else {
                quantiles(entries, refused)
            };
            Floor {
                samples: samples.max(0.0),
                roughness: roughness.max(0.0),
            }
        })
        .collect()
}

fn mean(entries: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|n| entries.iter().map(|e| e[n]).sum::<f64>() / entries.len().max(1) as f64)
}

/// The highest pair of floors, each with as many entries below it, that together refuse
/// no more than a share.
fn quantiles(entries: &[[f64; 2]], share: f64) -> [f64; 2] {
    let sorted = [0, 1].map(|n| {
        let mut column: Vec<f64> = entries.iter().map(|e| e[n]).collect();
        column.sort_by(f64::total_cmp);
        column
    });
    let most = share * entries.len() as f64;
    let floors = |rank: usize| [0, 1].map(|n: usize| sorted[n][rank]);
    let refused = |[a, b]: [f64; 2]| entries.iter().filter(|e| e[0] < a || e[1] < b).count();
    let ranks = (0..entries.len()).take_while(|&rank| refused(floors(rank)) as f64 <= most);
    ranks.last().map_or([0.0; 2], floors)
}
