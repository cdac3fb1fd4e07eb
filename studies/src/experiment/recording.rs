//! The data sets, which are simulated once and used by one experiment or more; the jobs of a
//! request, and what each of them records. The file of a rig says which job is which condition.

use std::collections::BTreeMap;

use anyhow::{Context, Result};
use host_sim::progress::Verbosity;

use super::{Extent, Request};
use crate::cores::Cores;
use crate::rigs::{corridor, floor, head, pad, seed_of, table};

/// A set of recordings on one rig. Their order is in the seeds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Dataset {
    Floor,
    Head,
    Table,
    Pad,
    Corridor,
    /// One vibrissa of the pad, sample by sample, in the pad's sweeps.
    Vibrissa,
}

impl Dataset {
    /// Its name in lower case.
    pub(crate) fn text(self) -> String {
        format!("{self:?}").to_lowercase()
    }

    /// The data set whose chance it has.
    pub(super) const fn drawn_as(self) -> Self {
        match self {
            Self::Vibrissa => Self::Pad,
            other => other,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Job {
    pub(crate) dataset: Dataset,
    pub(crate) number: usize,
}

/// What one job of a data set recorded: samples of some channels, one after
/// another. Sensor codes of 14 bits are exact in single precision.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Recording {
    pub(crate) channels: usize,
    pub(crate) values: Vec<f32>,
}

impl Recording {
    pub(crate) fn new(channels: usize, values: Vec<f32>) -> Self {
        Self { channels, values }
    }

    pub(crate) fn len(&self) -> usize {
        self.values.len() / self.channels.max(1)
    }

    /// The samples from `from` up to `to` (not included), as far as there are.
    pub(crate) fn part(&self, from: usize, to: usize) -> &[f32] {
        let end = (to * self.channels).min(self.values.len());
        let start = (from * self.channels).min(end);
        self.values.get(start..end).unwrap_or(&[])
    }

    pub(crate) fn segment(&self, from: usize, to: usize) -> Vec<f64> {
        self.part(from, to).iter().map(|x| f64::from(*x)).collect()
    }
}

pub(crate) type Recordings = BTreeMap<Job, Recording>;

/// The recordings of a set in the order of its jobs.
pub(crate) fn of_set(all: &Recordings, dataset: Dataset) -> Vec<&Recording> {
    let jobs = all.iter().filter(|(job, _)| job.dataset == dataset);
    jobs.map(|(_, recording)| recording).collect()
}

/// What records a job from its seed.
pub(super) type Record = fn(&Request, usize, u64) -> Result<Recording>;

/// How many jobs a data set has, and what records one.
fn rig(dataset: Dataset, extent: Extent) -> (usize, Record) {
    match dataset {
        Dataset::Floor => (floor::trials(extent).len(), floor::record),
        Dataset::Head => (head::jobs(), head::record),
        Dataset::Table => (table::jobs(extent), table::record),
        Dataset::Pad => (pad::jobs(extent), pad::record),
        Dataset::Vibrissa => (pad::jobs(extent), pad::record_one),
        Dataset::Corridor => (corridor::jobs(extent), corridor::record),
    }
}

pub(crate) fn jobs(request: &Request) -> Vec<Job> {
    let names = request.names.iter();
    let mut datasets: Vec<Dataset> = names.flat_map(|name| name.datasets()).copied().collect();
    datasets.sort_unstable();
    datasets.dedup();
    let of = |dataset| {
        let (count, _) = rig(dataset, request.extent);
        (0..count).map(move |number| Job { dataset, number })
    };
    datasets.into_iter().flat_map(of).collect()
}

/// Makes one recording. It depends on the seed, the rig and the job alone.
fn one(request: &Request, job: Job) -> Result<Recording> {
    let Job { dataset, number } = job;
    let drawn = dataset.drawn_as() as u64;
    let seed = seed_of(request.seed, &[drawn, number as u64]);
    let (_, record) = rig(dataset, request.extent);
    record(request, number, seed).with_context(|| dataset.text())
}

/// The result depends on neither the order of jobs nor the number of cores.
pub(crate) fn record(request: &Request, jobs: &[Job]) -> Result<Recordings> {
    Cores(Verbosity::Quiet)
        .each("recording", jobs, |job| Ok((*job, one(request, *job)?)))
        .map(|made| made.into_iter().collect())
}
