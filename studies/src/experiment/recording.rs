//! The data sets, which are simulated once and used by one experiment or more; what a rig
//! recorded, and which recordings there are.

use std::collections::BTreeMap;

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
    pub(crate) const fn text(self) -> &'static str {
        match self {
            Self::Floor => "floor",
            Self::Head => "head",
            Self::Table => "table",
            Self::Pad => "pad",
            Self::Corridor => "corridor",
            Self::Vibrissa => "vibrissa",
        }
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
