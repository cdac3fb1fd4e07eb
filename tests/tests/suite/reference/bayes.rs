//! The streaming Bayes classifier in double precision, recordings to decisions:
//! what `host-sim train` and `host-sim classify` mean (Lepora et al. 2010 and
//! 2012).
//!
//! Glossary. *Block*: the samples whose mean log-likelihood is added at once.
//! *Evidence*: summed log-likelihood of a class since the last decision. *Hit*: a
//! decision that equals the label.

use serde::Deserialize;

use super::recording::{Sample, streams};

/// Added to each smoothed, normalised bin before the logarithm.
const FLOOR: f64 = 1e-6;

/// Equal-width bins over a channel's range.
#[derive(Clone, Copy, Debug)]
struct Bins {
    low: f64,
    high: f64,
    count: usize,
}

impl Bins {
    /// The bin of a value; the upper edge is in the last bin, and values
    /// outside go to the edge bin.
    fn of(&self, value: f64) -> usize {
        let position = (value - self.low) * self.count as f64 / (self.high - self.low);
        // `as` saturates: below zero (and NaN, of an empty range) is bin 0.
        (position.floor() as usize).min(self.count - 1)
    }
}

#[derive(Clone, Debug)]
pub(crate) struct Model {
    /// Class names in the order of the training file.
    pub(crate) classes: Vec<String>,
    block: usize,
    bins: [Bins; 2],
    /// Log-likelihood of a bin: \[class\]\[channel\]\[bin\].
    log_likelihood: Vec<[Vec<f64>; 2]>,
}

/// Learns a model: `bins` bins a channel, smoothed over `smooth` bins, used in
/// blocks of `block` samples.
pub(crate) fn train(recording: &[Sample], bins: usize, smooth: f64, block: usize) -> Model {
    let mut classes: Vec<String> = Vec::new();
    for sample in recording {
        if !classes.contains(&sample.label) {
            classes.push(sample.label.clone());
        }
    }
    let bins = [0, 1].map(|channel: usize| {
        let values = || recording.iter().map(|sample| sample.channels()[channel]);
        Bins {
            low: values().fold(f64::INFINITY, f64::min),
            high: values().fold(f64::NEG_INFINITY, f64::max),
            count: bins,
        }
    });
    let of_class = |class: &String| {
        [0, 1].map(|channel: usize| {
            let mut counts = vec![0.0; bins[channel].count];
            for sample in recording.iter().filter(|sample| sample.label == *class) {
                counts[bins[channel].of(sample.channels()[channel])] += 1.0;
            }
            let smoothed = smoothed(&counts, smooth);
            let total: f64 = smoothed.iter().sum();
            let weights = smoothed.iter();
            weights
                .map(|weight| (weight / total + FLOOR).ln())
                .collect()
        })
    };
    Model {
        log_likelihood: classes.iter().map(of_class).collect(),
        classes,
        block,
        bins,
    }
}

/// Convolution with a Gaussian of standard deviation `sigma` bins, cut at four
/// of them, counts being zero outside the range.
fn smoothed(counts: &[f64], sigma: f64) -> Vec<f64> {
    let weight = |from: usize, to: usize| {
        let distance = from.abs_diff(to) as f64;
        if distance > 4.0 * sigma {
            0.0
        } else if distance == 0.0 {
            1.0 // also where sigma is 0: no smoothing
        } else {
            (-0.5 * (distance / sigma).powi(2)).exp()
        }
    };
    let smoothed = (0..counts.len()).map(|to| {
        let parts = counts.iter().enumerate();
        parts.map(|(from, count)| weight(from, to) * count).sum()
    });
    smoothed.collect()
}

/// When to decide.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Rule {
    /// After the block in which the largest posterior exceeds this.
    Sequential(f64),
    /// After this many samples, a multiple of the block.
    Window(usize),
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
pub(crate) struct Decided {
    /// The true class.
    pub(crate) label: String,
    pub(crate) trial: String,
    pub(crate) decision: String,
    pub(crate) samples: usize,
    pub(crate) posterior: f64,
}

/// Decisions on a recording, in stream order. Evidence is dropped at the end of
/// a stream.
pub(crate) fn classify(model: &Model, recording: &[Sample], rule: Rule) -> Vec<Decided> {
    let mut decisions = Vec::new();
    for stream in streams(recording) {
        let mut evidence = vec![0.0; model.classes.len()];
        let mut samples = 0;
        for block in stream.chunks_exact(model.block) {
            for (class, total) in evidence.iter_mut().enumerate() {
                *total += mean_log_likelihood(model, class, block);
            }
            samples += block.len();
            let (best, posterior) = winner(&evidence);
            let decided = match rule {
                Rule::Sequential(threshold) => posterior > threshold,
                Rule::Window(window) => samples == window,
            };
            if decided {
                decisions.push(Decided {
                    label: block[0].label.clone(),
                    trial: block[0].trial.clone(),
                    decision: model.classes[best].clone(),
                    samples,
                    posterior,
                });
                evidence.fill(0.0);
                samples = 0;
            }
        }
    }
    decisions
}

fn mean_log_likelihood(model: &Model, class: usize, block: &[Sample]) -> f64 {
    let mut sum = 0.0;
    for sample in block {
        for channel in 0..2 {
            let bin = model.bins[channel].of(sample.channels()[channel]);
            sum += model.log_likelihood[class][channel][bin];
        }
    }
    sum / block.len() as f64
}

/// The class of most evidence, the first of equals, and its posterior
/// probability under equal priors.
fn winner(evidence: &[f64]) -> (usize, f64) {
    let mut best = 0;
    for class in 1..evidence.len() {
        if evidence[class] > evidence[best] {
            best = class;
        }
    }
    let relative: f64 = evidence.iter().map(|e| (e - evidence[best]).exp()).sum();
    (best, 1.0 / relative)
}

/// Hit rate of each class averaged over the labels that have decisions, 0 to 1.
pub(crate) fn hit_rate(decisions: &[Decided]) -> f64 {
    let mut labels: Vec<&str> = decisions.iter().map(|d| d.label.as_str()).collect();
    labels.sort_unstable();
    labels.dedup();
    let of_label = |label: &str| {
        let own = || decisions.iter().filter(|d| d.label == label);
        own().filter(|d| d.decision == label).count() as f64 / own().count() as f64
    };
    labels.iter().map(|label| of_label(label)).sum::<f64>() / labels.len() as f64
}

pub(crate) fn mean_samples(decisions: &[Decided]) -> f64 {
    decisions.iter().map(|d| d.samples as f64).sum::<f64>() / decisions.len() as f64
}
