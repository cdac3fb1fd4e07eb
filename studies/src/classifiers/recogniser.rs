//! One way to ask any classifier, for experiments on a PC: samples in, the
//! name of a class out, whatever the method.
//!
//! [`Bayes`] wraps naive Bayes under any rule. [`Sprt`] is the sequential probability ratio test
//! between two classes (LEP12 eqs. 1 and 2), on the tables of a model of naive Bayes:
//! log PR = log HR + Σ log LR, with the prior ratio HR = P(H₁)/P(H₂) and the likelihood ratio LR
//! of each block, the mean over its samples as in LEP12 eq. 6. H₁ is decided where log PR is
//! log(θ/(1 − θ)) or more, H₂ where −log PR is.

use anyhow::Result;
use tactile::{
    Binner, Decision, DecisionRule, Model, NaiveBayes, Posteriors, Quantiser, SetupError,
};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Outcome {
    /// The class, from zero, in the order of training.
    pub(crate) class: usize,
    /// Samples that it took since the last outcome (or the start).
    pub(crate) samples: u32,
}

pub(crate) trait Recogniser {
    /// Takes one sample of all channels; gives an outcome where one falls.
    /// A sample of another number of channels is not taken.
    fn push(&mut self, sample: &[f64]) -> Option<Outcome>;

    /// The end of the segment: an outcome of those that wait for it. Then as new.
    fn finish(&mut self) -> Option<Outcome>;

    /// Of samples of `channels` values, one after another. Starts and ends as new.
    fn outcomes(&mut self, segment: &[f64], channels: usize) -> Vec<Outcome> {
        let samples = segment.chunks_exact(channels);
        let mut found: Vec<Outcome> = samples.filter_map(|sample| self.push(sample)).collect();
        found.extend(self.finish());
        found
    }
}

/// Naive Bayes by the code of a board: samples become codes by the quantisers of the model.
pub(crate) struct Bayes<'m, R: DecisionRule> {
    classifier: NaiveBayes<R, &'m [u32]>,
    quantisers: Vec<Quantiser>,
    codes: Vec<i32>,
}

impl<'m, R: DecisionRule> Bayes<'m, R> {
    /// Fails where the rule's settings do not fit the model.
    pub(crate) fn new(model: Model<&'m [u32]>, settings: R::Settings) -> Result<Self, SetupError> {
        let quantisers: Vec<_> = (0..model.channels())
            .filter_map(|channel| model.quantiser(channel))
            .collect();
        Ok(Self {
            classifier: NaiveBayes::new(model, settings)?,
            codes: Vec::with_capacity(quantisers.len()),
            quantisers,
        })
    }

    pub(crate) fn posteriors(&self) -> Posteriors {
        self.classifier.posteriors()
    }
}

impl From<Decision> for Outcome {
    fn from(decision: Decision) -> Self {
        Self {
            class: decision.leader(),
            samples: decision.samples(),
        }
    }
}

impl<R: DecisionRule> Recogniser for Bayes<'_, R> {
    fn push(&mut self, sample: &[f64]) -> Option<Outcome> {
        self.codes.clear();
        let codes = self.quantisers.iter().zip(sample);
        self.codes.extend(codes.map(|(q, &x)| q.code_from_f64(x)));
        let pushed = self.classifier.push(&self.codes);
        pushed.ok().flatten().map(Outcome::from)
    }

    fn finish(&mut self) -> Option<Outcome> {
        self.classifier.reset();
        None
    }
}

struct Channel {
    quantiser: Quantiser,
    binner: Binner,
    /// log LR of each bin.
    ratios: Vec<f64>,
}

/// The test: class 0 of the model is H₁, class 1 is H₂.
pub(crate) struct Sprt {
    channels: Vec<Channel>,
    block: u32,
    /// log HR.
    prior: f64,
    /// log(θ/(1 − θ)).
    threshold: f64,
    /// log PR so far.
    ratio: f64,
    /// Σ log LR of the block, and samples since the start.
    sum: f64,
    samples: u32,
}

impl Sprt {
    /// The test with a threshold θ on the probability, above 0.5 and below 1, and the prior ratio
    /// HR, above 0 and finite.
    pub(crate) fn new(
        model: Model<&[u32]>,
        theta: f64,
        prior_ratio: f64,
    ) -> Result<Self, SetupError> {
        let threshold = libm::log(theta / (1.0 - theta));
        let prior = libm::log(prior_ratio);
        if !(threshold > 0.0 && threshold.is_finite() && prior.is_finite()) || model.classes() < 2 {
            return Err(SetupError::Threshold);
        }
        let channel = |n: usize| {
            let (bins, quantiser) = (model.bins(n)?, model.quantiser(n)?);
            let log2 = |bin, class| model.log2_likelihood(n, bin, class).map(f64::from);
            let ratio = |bin| Some(std::f64::consts::LN_2 * (log2(bin, 0)? - log2(bin, 1)?));
            Some(Channel {
                quantiser,
                binner: quantiser.binner(bins).ok()?,
                ratios: (0..bins).map(ratio).collect::<Option<_>>()?,
            })
        };
        Ok(Self {
            channels: (0..model.channels()).filter_map(channel).collect(),
            block: model.block(),
            prior,
            threshold,
            ratio: prior,
            sum: 0.0,
            samples: 0,
        })
    }
}

impl Recogniser for Sprt {
    fn push(&mut self, sample: &[f64]) -> Option<Outcome> {
        if sample.len() != self.channels.len() {
            return None;
        }
        for (channel, x) in self.channels.iter().zip(sample) {
            let code = channel.quantiser.code_from_f64(*x);
            let last = channel.ratios.len().saturating_sub(1);
            let bin = channel.binner.bin(code, last);
            self.sum += channel.ratios.get(bin).copied().unwrap_or(0.0);
        }
        self.samples = self.samples.saturating_add(1);
        if !self.samples.is_multiple_of(self.block.max(1)) {
            return None;
        }
        self.ratio += std::mem::take(&mut self.sum) / f64::from(self.block.max(1));
        if self.ratio.abs() < self.threshold {
            return None;
        }
        let outcome = Outcome {
            class: usize::from(self.ratio < 0.0),
            samples: self.samples,
        };
        self.finish();
        Some(outcome)
    }

    fn finish(&mut self) -> Option<Outcome> {
        (self.ratio, self.sum, self.samples) = (self.prior, 0.0, 0);
        None
    }
}

#[cfg(test)]
mod tests {
    use super::{Recogniser, Sprt};
    use crate::rigs::Chance;
    use tactile::ModelBuf;
    use tactile::train::{Options, Trainer};

    fn sample(chance: &mut Chance, mean: f64) -> f64 {
        100.0 * chance.normal() + mean
    }

    /// Two classes of normal numbers, a quarter of a standard deviation apart, by samples of 1.
    fn model() -> ModelBuf {
        let options = Options {
            bins: 60,
            smooth: 0.5,
            block: 1,
        };
        let mut trainer = Trainer::new(1, options).unwrap();
        let mut chance = Chance::new(7);
        for (name, mean) in [("a", 0.0), ("b", 25.0)] {
            // So many that what tables have by chance is nothing beside what classes differ by.
            for _ in 0..400_000 {
                trainer.add(name, &[sample(&mut chance, mean)]).unwrap();
            }
        }
        trainer.train().unwrap()
    }

    /// Share of decisions for the wrong class where `class` is true, and the mean samples of one.
    fn errors(sprt: &mut Sprt, class: usize) -> (f64, f64) {
        let mut chance = Chance::new(11 + class as u64);
        let mut next = |_| sample(&mut chance, 25.0 * class as f64);
        let stream: Vec<f64> = (0..1_000_000).map(&mut next).collect();
        let found = sprt.outcomes(&stream, 1);
        let wrong = found.iter().filter(|one| one.class != class).count() as f64;
        let samples: u32 = found.iter().map(|one| one.samples).sum();
        let count = found.len() as f64;
        (wrong / count, f64::from(samples) / count)
    }

    /// From a start log HR the ways to the thresholds are log A and log B. Wald's errors are
    /// (A − 1) B / (A − B) and (1 − B) / (A − B); overshoot makes them less, by about
    /// exp(−0.583 d), d = 0.25.
    #[test]
    fn errors_are_walds_with_a_prior_ratio_and_without() {
        let model = model();
        for (ratio, up, down) in [(1.0, 19.0_f64, 1.0 / 19.0), (4.0, 4.75, 1.0 / 76.0)] {
            let mut sprt = Sprt::new(model.view(), 0.95, ratio).unwrap();
            let (likely, quick) = errors(&mut sprt, 0);
            let (other, slow) = errors(&mut sprt, 1);
            let walds = [(up - 1.0) * down / (up - down), (1.0 - down) / (up - down)];
            for (found, wald) in [(likely, walds[0]), (other, walds[1])] {
                assert!(
                    (0.75..1.0).contains(&(found / wald)),
                    "{ratio}: {found} {wald}"
                );
            }
            assert!(ratio == 1.0 || quick < 0.9 * slow);
            if ratio == 1.0 {
                // ((1 − α) log((1 − α)/α) + α log(α/(1 − α))) over the divergence d²/2.
                let time = quick / (0.9 * up.ln() / 0.03125);
                assert!((0.97..1.12).contains(&time), "{time}");
            }
        }
        assert!(Sprt::new(model.view(), 0.5, 1.0).is_err());
        assert!(Sprt::new(model.view(), 0.9, 0.0).is_err());
    }
}
