//! Whisks as the two classifiers of BIOTACT section IV are trained on and take them.

use anyhow::Result;
use host_sim::recording::Stream;
use tactile::WindowRule;
use tactile::train::{Options, Trainer};

use crate::classifiers::{Bayes, Recogniser, Templates};
use crate::experiment::{Dataset, Recordings, Request, of_set, product};
use crate::page::Page;
use crate::paper::biotact::{DISTANCES_MM, STRATEGIES, TEXTURES};
use crate::rigs::CHANNELS;
use crate::rigs::head::COLUMNS;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Method {
    /// Stationary naive Bayes (eq. 15–16): over a window of a whole whisk, each sample for itself,
    /// log P(C_l | x_1 … x_n) = Σ_w Σ_i log P_w(x_i | C_l).
    Bayes,
    /// Sum of squared differences (eq. 17).
    Template,
}

impl Method {
    pub(super) const ALL: [Self; 2] = [Self::Bayes, Self::Template];

    /// In text, and as a score has it.
    pub(super) const fn names(self) -> (&'static str, &'static str) {
        match self {
            Self::Bayes => ("naive Bayes", "stationary naive Bayes, 12 channels"),
            Self::Template => (
                "the template by sum of squares",
                "template by sum of squares, 12 channels",
            ),
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Task {
    Both,
    Texture,
    Distance,
}

impl Task {
    pub(super) const ALL: [Self; 3] = [Self::Both, Self::Texture, Self::Distance];

    pub(super) const fn text(self) -> &'static str {
        match self {
            Self::Both => "texture and distance",
            Self::Texture => "texture",
            Self::Distance => "distance",
        }
    }

    /// The hit rate of chance, percent, and that where distances are told without error and
    /// textures are not.
    pub(super) const fn chance(self) -> (f64, Option<f64>) {
        let of_textures = 100.0 / TEXTURES.len() as f64;
        let both = TEXTURES.len() * DISTANCES_MM.len();
        match self {
            Self::Both => (100.0 / both as f64, Some(of_textures)),
            Self::Texture => (of_textures, Some(of_textures)),
            Self::Distance => (100.0 / DISTANCES_MM.len() as f64, None),
        }
    }

    const fn class(self, texture: usize, distance: usize) -> usize {
        match self {
            Self::Both => texture * DISTANCES_MM.len() + distance,
            Self::Texture => texture,
            Self::Distance => distance,
        }
    }
}

/// A whisk: its texture, distance and samples of all channels.
type Whisk = (usize, usize, Vec<f64>);

/// Numbers of the whisks to train on and to validate with.
type Split<'a> = (&'a [usize], &'a [usize]);

pub(super) struct Visits {
    /// `[strategy][whisk number]`: one whisk of each condition.
    whisks: Vec<Vec<Vec<Whisk>>>,
    ticks: usize,
    options: Options,
}

impl Visits {
    pub(super) fn new(request: &Request, recordings: &Recordings) -> Self {
        let all = of_set(recordings, Dataset::Head);
        let ticks = request.rigs.head.whisk_ticks();
        let mut whisks = vec![vec![Vec::new(); request.extent.whisks]; STRATEGIES.len()];
        let of_strategy = TEXTURES.len() * DISTANCES_MM.len();
        let classified = all.iter().take(of_strategy * STRATEGIES.len());
        for (job, visit) in classified.enumerate() {
            let (strategy, condition) = (job / of_strategy, job % of_strategy);
            let (texture, distance) = (
                condition / DISTANCES_MM.len(),
                condition % DISTANCES_MM.len(),
            );
            for (n, whisk) in whisks[strategy].iter_mut().enumerate() {
                let felt = visit.part(n * ticks, (n + 1) * ticks).chunks_exact(COLUMNS);
                let felt = felt.flat_map(|row| row.iter().take(CHANNELS));
                let felt = felt.map(|x| f64::from(*x)).collect();
                whisk.push((texture, distance, felt));
            }
        }
        let options = Options {
            smooth: request.rigs.head.smooth_bins,
            block: 1,
            ..Options::default()
        };
        Self {
            whisks,
            ticks,
            options,
        }
    }

    fn some(&self, strategy: usize, numbers: &[usize]) -> impl Iterator<Item = &Whisk> {
        numbers.iter().flat_map(move |n| &self.whisks[strategy][*n])
    }

    /// Share of validation whisks that a classifier, as the paper has it, names rightly.
    pub(super) fn hit_rate(
        &self,
        method: Method,
        task: Task,
        strategy: usize,
        (training, validation): Split<'_>,
    ) -> Result<f64> {
        let class = |whisk: &Whisk| task.class(whisk.0, whisk.1);
        let known = self.some(strategy, training);
        let validation = self.some(strategy, validation);
        match method {
            Method::Template => {
                let known = known.map(|whisk| (class(whisk), &whisk.2[..]));
                let templates = Templates::of(known, true)?;
                Ok(share(task, validation, |x| Some(templates.classify(x))))
            }
            Method::Bayes => {
                let mut trainer = Trainer::new(CHANNELS, self.options)?;
                // Classes are numbered as they first appear: put them in order.
                let mut sorted: Vec<&Whisk> = known.collect();
                sorted.sort_by_key(|whisk| class(whisk));
                for whisk in sorted {
                    let name = format!("class {}", class(whisk));
                    for sample in whisk.2.chunks_exact(CHANNELS) {
                        trainer.add(&name, sample)?;
                    }
                }
                let buf = trainer.train()?;
                let mut bayes = Bayes::<WindowRule>::new(buf.view(), self.ticks as u32)?;
                Ok(share(task, validation, |whisk| {
                    let found = bayes.outcomes(whisk, CHANNELS);
                    found.first().map(|outcome| outcome.class)
                }))
            }
        }
    }
}

fn share<'w>(
    task: Task,
    validation: impl Iterator<Item = &'w Whisk>,
    mut named: impl FnMut(&[f64]) -> Option<usize>,
) -> f64 {
    let (mut hits, mut count) = (0_u32, 0_u32);
    for (texture, distance, samples) in validation {
        let class = task.class(*texture, *distance);
        hits += u32::from(named(samples) == Some(class));
        count += 1;
    }
    f64::from(hits) / f64::from(count.max(1))
}

/// Says what the product's own rule makes of textures by the left front whisker alone, the first
/// `most` whisks of each strategy to train on.
pub(super) fn of_one_whisker(
    page: &mut Page,
    visits: &Visits,
    rate_hz: f64,
    most: usize,
) -> Result<()> {
    let order: Vec<usize> = (0..visits.whisks[0].len()).collect();
    let (training, testing) = order.split_at(most.min(order.len()));
    let streams = |strategy: usize, numbers: &[usize]| -> Result<Vec<Stream>> {
        let one = |(n, (texture, _, samples)): (usize, &Whisk)| {
            let pairs = samples.chunks_exact(CHANNELS).map(|all| [all[0], all[1]]);
            product::stream(TEXTURES[*texture].0, n, pairs.collect(), Some(rate_hz))
        };
        let whisks = visits.some(strategy, numbers).enumerate();
        whisks.map(one).collect()
    };
    let mut tasks = Vec::new();
    for (strategy, (name, _)) in STRATEGIES.iter().enumerate() {
        let name = format!("texture by one whisker, {name}");
        let (training, testing) = (streams(strategy, training)?, streams(strategy, testing)?);
        tasks.push((name, training, testing));
    }
    product::section(page, rate_hz, tasks)
}
