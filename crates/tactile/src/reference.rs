//! The same classification in double precision, written straight from its
//! definition and sharing no code with the fixed-point path: something to
//! compare that path with, and a yardstick for tables and rounding.

use std::vec;
use std::vec::Vec;

use crate::format::LOG_FLOOR;
use crate::train::{Options, Trainer};

/// A decision of the reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReferenceDecision {
    /// The class decided for.
    pub class: usize,
    /// Samples it used.
    pub samples: u64,
    /// Its posterior probability.
    pub posterior: f64,
}

/// When to decide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ReferenceRule {
    /// After the block in which a posterior exceeds this probability.
    Sequential(f64),
    /// After each run of so many samples.
    Window(u64),
    /// When asked, with every sample counted in full.
    Stationary,
}

/// Natural log-likelihoods in double precision.
#[derive(Debug, Clone)]
pub struct Reference {
    options: Options,
    classes: usize,
    /// Range of each channel.
    ranges: Vec<(f64, f64)>,
    /// ln p of each channel, bin, class.
    log_p: Vec<Vec<Vec<f64>>>,
}

/// A stream under the reference.
#[derive(Debug, Clone)]
pub struct ReferenceStream<'r> {
    reference: &'r Reference,
    rule: ReferenceRule,
    /// Sums of the open block and evidence of the blocks before.
    block: Vec<f64>,
    evidence: Vec<f64>,
    samples: u64,
}

impl Reference {
    /// Trains on a trainer's samples (not from its tables). None without
    /// samples of two classes.
    pub fn train(trainer: &Trainer) -> Option<Self> {
        let options = trainer.options();
        let classes = trainer.names().len();
        if classes < 2 {
            return None;
        }
        let mut ranges = vec![(f64::INFINITY, f64::NEG_INFINITY); trainer.channels()];
        for (_, sample) in trainer.samples() {
            for (range, &x) in ranges.iter_mut().zip(sample) {
                *range = (range.0.min(x), range.1.max(x));
            }
        }
        let mut counts = vec![vec![vec![0.0; classes]; options.bins]; ranges.len()];
        for (class, sample) in trainer.samples() {
            for (channel, &x) in sample.iter().enumerate() {
                counts[channel][bin_of(x, ranges[channel], options.bins)][class] += 1.0;
            }
        }
        let log_p = counts
            .iter()
            .map(|histogram| log_likelihoods(histogram, options.smooth))
            .collect();
        Some(Self {
            options,
            classes,
            ranges,
            log_p,
        })
    }

    /// Starts a stream.
    pub fn stream(&self, rule: ReferenceRule) -> ReferenceStream<'_> {
        ReferenceStream {
            reference: self,
            rule,
            block: vec![0.0; self.classes],
            evidence: vec![0.0; self.classes],
            samples: 0,
        }
    }
}

impl ReferenceStream<'_> {
    /// Takes one sample of all channels.
    pub fn push(&mut self, sample: &[f64]) -> Option<ReferenceDecision> {
        let r = self.reference;
        for (channel, &x) in sample.iter().enumerate() {
            let bin = bin_of(x, r.ranges[channel], r.options.bins);
            for (sum, log_p) in self.block.iter_mut().zip(&r.log_p[channel][bin]) {
                *sum += log_p;
            }
        }
        self.samples += 1;
        let block = u64::from(r.options.block);
        if !self.samples.is_multiple_of(block) || self.rule == ReferenceRule::Stationary {
            return None;
        }
        for (evidence, sum) in self.evidence.iter_mut().zip(&mut self.block) {
            *evidence += *sum / block as f64;
            *sum = 0.0;
        }
        let decision = self.best();
        let decided = match self.rule {
            ReferenceRule::Sequential(threshold) => decision.posterior > threshold,
            ReferenceRule::Window(window) => self.samples == window,
            ReferenceRule::Stationary => false,
        };
        if !decided {
            return None;
        }
        self.reset();
        Some(decision)
    }

    /// Ends the stream: the stationary rule decides, the others drop what is left.
    pub fn finish(&mut self) -> Option<ReferenceDecision> {
        let asked = self.rule == ReferenceRule::Stationary && self.samples > 0;
        self.evidence.copy_from_slice(&self.block);
        let decision = asked.then(|| self.best());
        self.reset();
        decision
    }

    /// Posterior of each class after the last full block.
    pub fn posteriors(&self) -> Vec<f64> {
        let most = self.evidence.iter().copied().fold(f64::MIN, f64::max);
        let terms: Vec<f64> = self.evidence.iter().map(|e| (e - most).exp()).collect();
        let sum: f64 = terms.iter().sum();
        terms.iter().map(|t| t / sum).collect()
    }

    fn best(&self) -> ReferenceDecision {
        let posteriors = self.posteriors();
        let mut class = 0;
        for (k, p) in posteriors.iter().enumerate() {
            if *p > posteriors[class] {
                class = k;
            }
        }
        ReferenceDecision {
            class,
            samples: self.samples,
            posterior: posteriors[class],
        }
    }

    fn reset(&mut self) {
        self.block.fill(0.0);
        self.evidence.fill(0.0);
        self.samples = 0;
    }
}

fn bin_of(x: f64, (low, high): (f64, f64), bins: usize) -> usize {
    if high <= low {
        return 0;
    }
    let bin = ((x - low) * bins as f64 / (high - low)).floor();
    bin.clamp(0.0, (bins - 1) as f64) as usize
}

/// ln(p + floor) of each bin and class: the smoothed histogram by its
/// definition, a double sum over bins.
fn log_likelihoods(histogram: &[Vec<f64>], smooth: f64) -> Vec<Vec<f64>> {
    let weight = |i: usize, j: usize| {
        let distance = i.abs_diff(j) as f64;
        if i == j {
            1.0
        } else if distance <= 4.0 * smooth {
            (-distance * distance / (2.0 * smooth * smooth)).exp()
        } else {
            0.0
        }
    };
    let classes = histogram.first().map_or(0, Vec::len);
    let smoothed: Vec<Vec<f64>> = (0..histogram.len())
        .map(|i| {
            (0..classes)
                .map(|k| {
                    let terms = histogram.iter().enumerate();
                    terms.map(|(j, counts)| counts[k] * weight(i, j)).sum()
                })
                .collect()
        })
        .collect();
    let sums: Vec<f64> = (0..classes)
        .map(|k| smoothed.iter().map(|bin| bin[k]).sum())
        .collect();
    smoothed
        .iter()
        .map(|bin| {
            let normalised = bin.iter().zip(&sums);
            normalised
                .map(|(p, sum)| (p / sum + LOG_FLOOR).ln())
                .collect()
        })
        .collect()
}
