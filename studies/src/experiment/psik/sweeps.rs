//! The sweeps over the sandpapers, and the networks that are trained on them.

use anyhow::Result;
use tactile::score::Confusion;

use crate::classifiers::network::{self, Network, Options, Row};
use crate::experiment::record::pad::{PAPERS, place};
use crate::experiment::recording::Recording;
use crate::experiment::request::Request;

/// Names of the sandpapers, from coarse to fine.
pub(super) const NAMES: [&str; PAPERS] =
    ["P40", "P50", "P60", "P80", "P100", "P120", "P150", "P180"];

/// Penalties λ on weights that are tried; the paper names none. Trained to the
/// end with hardly any, 1400 weights fit the scatter of a few hundred sweeps.
pub(super) const PENALTIES: [f64; 3] = [1e-5, 1e-4, 1e-3];

/// One sweep of so many is held out to choose the penalty.
const HELD_OUT: usize = 5;

/// The penalty is the best on sweeps held out of the training ones, the smallest of equals.
fn train_choosing(rows: &[Row], seed: u64) -> Result<Network> {
    let mut best = (0, Options::imp(seed).decay);
    let places = || rows.iter().enumerate();
    let kept = places().filter(|(n, _)| n % HELD_OUT != 0);
    let kept: Vec<Row> = kept.map(|(_, row)| row.clone()).collect();
    for penalty in PENALTIES {
        let network = train(&kept, seed, penalty)?;
        let mut hits = 0;
        for (_, (class, row)) in places().filter(|(n, _)| n % HELD_OUT == 0) {
            hits += usize::from(network.classify(row)? == *class);
        }
        if hits > best.0 {
            best = (hits, penalty);
        }
    }
    train(rows, seed, best.1)
}

pub(super) fn train(rows: &[Row], seed: u64, penalty: f64) -> Result<Network> {
    let inputs = rows.first().map_or(0, |(_, row)| row.len());
    let options = Options {
        decay: penalty,
        hidden: inputs,
        ..Options::imp(seed)
    };
    network::train(rows, &options)
}

pub(super) struct Sweeps {
    pub(super) training: Vec<Row>,
    pub(super) testing: Vec<Row>,
}

impl Sweeps {
    pub(super) fn new(request: &Request, all: &[&Recording]) -> Self {
        let mut sweeps = Self {
            training: Vec::new(),
            testing: Vec::new(),
        };
        for (job, recording) in all.iter().enumerate() {
            let (paper, sweep) = place(request.extent, job);
            let row = (paper, recording.segment(0, 1));
            if sweep < request.extent.sweeps().0 {
                sweeps.training.push(row);
            } else {
                sweeps.testing.push(row);
            }
        }
        sweeps
    }

    /// Trains and tests with the vibrissae from `from` up to `to`.
    pub(super) fn score(&self, from: usize, to: usize, seed: u64) -> Result<Confusion> {
        let cut = |rows: &[Row]| -> Vec<Row> {
            let some = |(class, row): &Row| (*class, row[from..to].to_vec());
            rows.iter().map(some).collect()
        };
        let network = train_choosing(&cut(&self.training), seed)?;
        let mut score = Confusion::new(PAPERS);
        for (class, row) in cut(&self.testing) {
            let named = network.classify(&row)?;
            score.add(class, Some(named))?;
        }
        Ok(score)
    }
}

/// Hit rate of the paper's own grades, P50 to P180, percent, among all eight: P40 is ours.
pub(super) fn hit(score: &Confusion) -> f64 {
    let own = (1..PAPERS).map(|class| score.hit_rate_of(class).unwrap_or(0.0));
    100.0 * own.sum::<f64>() / (PAPERS - 1) as f64
}

pub(super) fn hit_of_p40(score: &Confusion) -> f64 {
    100.0 * score.hit_rate_of(0).unwrap_or(0.0)
}

/// The class with the most votes, the first of equals.
pub(super) fn most(votes: &[u32; 4]) -> usize {
    let places = 1..votes.len();
    places.fold(0, |best, k| if votes[k] > votes[best] { k } else { best })
}

pub(super) fn mean_hit<const N: usize>(table: &[[f64; N]; N]) -> f64 {
    let hits = table.iter().enumerate().map(|(n, row)| row[n]);
    hits.sum::<f64>() / N as f64
}
