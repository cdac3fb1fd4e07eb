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
use super::request::{Depth, Extent, Request};
use crate::cores::each;
use crate::rigs::seed_of;
use anyhow::{Context, Result};
use host_sim::progress::Verbosity;

fn all(dataset: Dataset, extent: Extent) -> impl Iterator<Item = Job> {
    let count = match dataset {
        Dataset::Floor => floor::jobs(extent),
        Dataset::Head => head::jobs(),
        Dataset::Table => table::jobs(extent),
        Dataset::Pad | Dataset::Vibrissa => pad::jobs(extent),
        Dataset::Corridor => corridor::jobs(extent),
    };
    (0..count).map(move |number| Job { dataset, number })
}

pub(crate) fn jobs(request: &Request) -> Vec<Job> {
    let names = request.names.iter();
    let mut datasets: Vec<Dataset> = names.flat_map(|name| name.datasets()).copied().collect();
    datasets.sort_unstable();
    datasets.dedup();
    datasets.retain(|dataset| *dataset != Dataset::Corridor || request.depth >= Depth::Textures);
    let of = |dataset| all(dataset, request.extent);
    datasets.into_iter().flat_map(of).collect()
}

/// Makes one recording. It depends on the seed, the rig and the job alone.
fn one(request: &Request, job: Job) -> Result<Recording> {
    let Job { dataset, number } = job;
    let drawn = dataset.drawn_as() as u64;
    let seed = seed_of(request.seed, &[drawn, number as u64]);
    let record = match dataset {
        Dataset::Floor => floor::record,
        Dataset::Head => head::record,
        Dataset::Table => table::record,
        Dataset::Pad => pad::record,
        Dataset::Corridor => corridor::record,
        Dataset::Vibrissa => pad::record_one,
    };
    record(request, number, seed).context(dataset.text())
}

/// The result depends on neither the order of jobs nor the number of cores.
pub(crate) fn record(request: &Request, jobs: &[Job], verbosity: Verbosity) -> Result<Recordings> {
    each(verbosity, "recording", jobs, |job| {
        Ok((*job, one(request, *job)?))
    })
    .map(|made| made.into_iter().collect())
}
