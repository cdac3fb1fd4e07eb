//! Recording: the jobs of a request, and what each of them records. A data set
//! has a file of its own, which says which job is which condition.

pub(crate) mod corridor;
pub(crate) mod floor;
pub(crate) mod head;
pub(crate) mod pad;
pub(crate) mod pads;
pub(crate) mod table;
pub(crate) mod whiskers;

use super::recording::{Dataset, Job, Recording, Recordings};
use super::request::{Extent, Request};
use crate::cores::Cores;
use crate::rigs::seed_of;
use anyhow::{Context, Result};
use host_sim::progress::Verbosity;

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
    record(request, number, seed).context(dataset.text())
}

/// The result depends on neither the order of jobs nor the number of cores.
pub(crate) fn record(request: &Request, jobs: &[Job]) -> Result<Recordings> {
    Cores(Verbosity::Quiet)
        .each("recording", jobs, |job| Ok((*job, one(request, *job)?)))
        .map(|made| made.into_iter().collect())
}
