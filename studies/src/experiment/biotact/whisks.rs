//! Whisks as the two classifiers of BIOTACT section IV are trained on and take them.

use anyhow::Result;
use tactile::train::{Options, Trainer};

use crate::classifiers::recogniser::{Bayes, outcomes};
use crate::classifiers::stationary::StationaryRule;
use crate::classifiers::template::TemplateTrainer;
use crate::experiment::record::head::{COLUMNS, number};
use crate::experiment::recording::{Dataset, Recordings, of_set};
use crate::experiment::request::Request;
use crate::paper::biotact::{DISTANCES_MM, STRATEGIES, TEXTURES};
use crate::rigs::CHANNELS;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Method {
    /// Stationary naive Bayes (eq. 15–16).
    Bayes,
    /// Sum of squared differences (eq. 17).
    Template,
}

impl Method {
    pub(super) const ALL: [Self; 2] = [Self::Bayes, Self::Template];

    pub(super) const fn text(self) -> &'static str {
        match self {
            Self::Bayes => "naive Bayes",
            Self::Template => "the template by sum of squares",
        }
    }

    pub(super) const fn score_name(self) -> &'static str {
        match self {
            Self::Bayes => "stationary naive Bayes, 12 channels",
            Self::Template => "template by sum of squares, 12 channels",
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
pub(super) type Whisk = (usize, usize, Vec<f64>);

/// Numbers of the whisks to train on and to validate with.
type Split<'a> = (&'a [usize], &'a [usize]);

#[derive(Debug)]
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
        let mut whisks = vec![vec![Vec::new(); request.extent.whisks()]; STRATEGIES.len()];
        for (strategy, whisks) in whisks.iter_mut().enumerate() {
            for texture in 0..TEXTURES.len() {
                for distance in 0..DISTANCES_MM.len() {
                    let Some(visit) = all.get(number(strategy, texture, distance)) else {
                        continue;
                    };
                    for (n, whisk) in whisks.iter_mut().enumerate() {
                        let samples = visit.part(n * ticks, (n + 1) * ticks);
                        let felt = samples.chunks_exact(COLUMNS);
                        let felt = felt.flat_map(|row| row.iter().take(CHANNELS));
                        let felt = felt.map(|x| f64::from(*x)).collect();
                        whisk.push((texture, distance, felt));
                    }
                }
            }
        }
        let options = Options {
            smooth: request.rigs.head.smooth_bins,
            ..Options::default()
        };
        Self {
            whisks,
            ticks,
            options,
        }
    }

    pub(super) fn count(&self) -> usize {
        self.whisks.first().map_or(0, Vec::len)
    }

    pub(super) fn some(&self, strategy: usize, numbers: &[usize]) -> impl Iterator<Item = &Whisk> {
        let whisks = self.whisks.get(strategy).map_or(&[][..], Vec::as_slice);
        numbers.iter().filter_map(|n| whisks.get(*n)).flatten()
    }

    /// Share of validation whisks that a classifier, as the paper has it, names
    /// rightly.
    pub(super) fn hit_rate(
        &self,
        method: Method,
        task: Task,
        strategy: usize,
        split: Split<'_>,
    ) -> Result<f64> {
        match method {
            Method::Bayes => self.bayes(task, strategy, split),
            Method::Template => self.template(task, strategy, split),
        }
    }

    fn template(&self, task: Task, strategy: usize, split: Split<'_>) -> Result<f64> {
        let (training, validation) = split;
        let mut trainer = TemplateTrainer::new(CHANNELS, self.ticks);
        for (texture, distance, samples) in self.some(strategy, training) {
            let class = task.class(*texture, *distance);
            trainer.add(class, samples)?;
        }
        let templates = trainer.train().in_codes();
        let validation = self.some(strategy, validation);
        Ok(share(task, validation, |whisk| {
            Some(templates.classify(whisk))
        }))
    }

    fn bayes(&self, task: Task, strategy: usize, (training, validation): Split<'_>) -> Result<f64> {
        let mut trainer = Trainer::new(CHANNELS, self.options)?;
        // Classes are numbered as they first appear: put them in order.
        let mut sorted: Vec<&Whisk> = self.some(strategy, training).collect();
        sorted.sort_by_key(|(texture, distance, _)| task.class(*texture, *distance));
        for (texture, distance, samples) in sorted {
            let name = format!("class {}", task.class(*texture, *distance));
            for sample in samples.chunks_exact(CHANNELS) {
                trainer.add(&name, sample)?;
            }
        }
        let buf = trainer.train()?;
        let model = buf.view();
        let mut bayes = Bayes::<StationaryRule>::new(model, ())?;
        let validation = self.some(strategy, validation);
        Ok(share(task, validation, |whisk| {
            let found = outcomes(&mut bayes, whisk, CHANNELS);
            found.first().map(|outcome| outcome.class)
        }))
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
