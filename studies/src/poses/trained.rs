//! Trainings, each with fresh presentations as it was trained.

use anyhow::Result;
use host_sim::evaluation::presentations;
use host_sim::recording::Stream;
use host_sim::training::{Expected, How, Tables};
use tactile::ModelBuf;

use super::{Change, Extent, Setting, Tally};
use crate::cores::Cores;

/// At which a class is named, unless said otherwise.
pub(super) const THRESHOLD: f64 = 0.99;
pub(super) const TICK_HZ: u32 = 2000;

pub(super) type Recordings = Vec<(String, Vec<Stream>)>;

/// Models for testing, a recording's labels changed by chance of this seed.
pub(super) type Relabel<'r> = &'r (dyn Fn(&mut Vec<Stream>, u64) + Sync);

pub(super) struct Trained<'s> {
    pub(super) cores: Cores,
    /// The first seed of each training: a recording each from there on.
    pub(super) seeds: Vec<u64>,
    /// Of each training, by pose.
    pub(super) recordings: Vec<Recordings>,
    /// What is tested, its changes left out.
    test: Setting<'s>,
    /// Of each training some presentations in the pose of training, or the middle one.
    pub(super) fresh: Vec<Vec<Stream>>,
}

impl<'s> Trained<'s> {
    /// Records `poses` for as many trainings as `extent` has of its `kind`, and what they are
    /// tested with.
    pub(super) fn record(
        (extent, kind): (&Extent, usize),
        (poses, seeds): (&[Setting<'_>], impl Iterator<Item = u64>),
        (test, first_test): (Setting<'s>, u64),
    ) -> Result<Self> {
        let cores = extent.cores;
        let test = Setting {
            seconds: Some(extent.test_s[kind]),
            ..test
        };
        let seeds: Vec<u64> = seeds.take(extent.trainings[kind]).collect();
        let jobs = seeds.iter().flat_map(|&seed| poses.iter().zip(seed..));
        let jobs: Vec<(&Setting<'_>, u64)> = jobs.collect();
        let made = cores.each("trainings", &jobs, |(pose, seed)| {
            Ok((seed.to_string(), pose.record(*seed)?))
        })?;
        let recordings = made.chunks(poses.len()).map(<[_]>::to_vec).collect();
        let tests: Vec<u64> = (first_test..).take(seeds.len()).collect();
        let fresh = cores.each("fresh presentations", &tests, |&seed| test.record(seed))?;
        Ok(Self {
            cores,
            seeds,
            recordings,
            test,
            fresh,
        })
    }

    /// A model of each training, by the defaults of `host-sim train`.
    pub(super) fn models(&self, expect: Expected, relabel: Relabel<'_>) -> Result<Vec<ModelBuf>> {
        let jobs: Vec<_> = self.recordings.iter().zip(&self.seeds).collect();
        self.cores.each("models", &jobs, |(recordings, seed)| {
            let mut recordings = (*recordings).clone();
            for ((_, streams), n) in recordings.iter_mut().zip(**seed..) {
                relabel(streams, n);
            }
            model(&recordings, expect)
        })
    }

    pub(super) fn presentations(&self, changes: &[Change], seed: u64) -> Result<Vec<Stream>> {
        Setting {
            changes,
            ..self.test
        }
        .record(seed)
    }

    pub(super) fn fresh(&self, models: &[ModelBuf], threshold: f64) -> Result<Vec<Tally>> {
        let all = models.iter().zip(&self.fresh);
        all.map(|(model, streams)| judge(model, threshold, streams))
            .collect()
    }

    /// The same of some of them, at the usual threshold.
    pub(super) fn fresh_of(
        &self,
        models: &[ModelBuf],
        keep: impl Fn(&Stream) -> bool,
    ) -> Result<Vec<Tally>> {
        let some = |(model, streams): (&ModelBuf, &Vec<Stream>)| {
            let streams: Vec<Stream> = streams.iter().filter(|s| keep(s)).cloned().collect();
            judge(model, THRESHOLD, &streams)
        };
        models.iter().zip(&self.fresh).map(some).collect()
    }

    /// What each kind of models, one of each training, makes of presentations with each
    /// change: by condition and kind a tally of each training.
    pub(super) fn changed(
        &self,
        conditions: &[Change],
        kinds: &[&[ModelBuf]],
        first_test: u64,
    ) -> Result<Vec<Vec<Vec<Tally>>>> {
        let trainings = self.seeds.len();
        let jobs: Vec<usize> = (0..conditions.len() * trainings).collect();
        let found = self.cores.each("conditions", &jobs, |&job| {
            let (condition, training) = (job / trainings, job % trainings);
            let seed = first_test + job as u64;
            let streams = self.presentations(&conditions[condition..=condition], seed)?;
            let judged = |models: &&[ModelBuf]| judge(&models[training], THRESHOLD, &streams);
            kinds.iter().map(judged).collect::<Result<Vec<Tally>>>()
        })?;
        let by_kind = |cells: &[Vec<Tally>]| {
            let of = |kind: usize| cells.iter().map(|cell| cell[kind]).collect();
            (0..kinds.len()).map(of).collect()
        };
        Ok(found.chunks(trainings).map(by_kind).collect())
    }
}

pub(super) fn model(recordings: &Recordings, expect: Expected) -> Result<ModelBuf> {
    let how = How {
        expect,
        ..How::of(Tables::Joint)
    };
    Ok(how.train(recordings, TICK_HZ)?.model)
}

pub(super) fn judge(model: &ModelBuf, threshold: f64, streams: &[Stream]) -> Result<Tally> {
    let shown = presentations(model, threshold, streams)?;
    Ok(Tally::of(&shown))
}

pub(super) fn as_felt(_: &mut Vec<Stream>, _: u64) {}
