//! The data sets: what is simulated once and used by one experiment or more.

use super::record;
use super::recording::Recording;
use super::request::{Request, Scale};
use crate::rigs::seed_of;
use host_sim::Error;

/// A set of recordings on one rig.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Dataset {
    /// The floor robot.
    Floor,
    /// The whisking head.
    Head,
    /// The XY table.
    Table,
    /// The fixed head with its pad.
    Pad,
    /// The mobile robot in its corridors.
    Corridor,
}

impl Dataset {
    const ALL: [Self; 5] = [
        Self::Floor,
        Self::Head,
        Self::Table,
        Self::Pad,
        Self::Corridor,
    ];

    /// Its name.
    pub const fn text(self) -> &'static str {
        match self {
            Self::Floor => "floor",
            Self::Head => "head",
            Self::Table => "table",
            Self::Pad => "pad",
            Self::Corridor => "corridor",
        }
    }

    /// Its number in part files and seeds.
    pub const fn number(self) -> u32 {
        match self {
            Self::Floor => 0,
            Self::Head => 1,
            Self::Table => 2,
            Self::Pad => 3,
            Self::Corridor => 4,
        }
    }

    /// The set of a number.
    pub fn from_number(number: u32) -> Option<Self> {
        Self::ALL.into_iter().find(|set| set.number() == number)
    }

    /// How many recordings it has.
    pub fn jobs(self, scale: Scale) -> usize {
        match self {
            Self::Floor => record::floor::jobs(scale),
            Self::Head => record::head::jobs(),
            Self::Table => record::table::jobs(scale),
            Self::Pad => record::pad::jobs(scale),
            Self::Corridor => record::corridor::jobs(scale),
        }
    }

    /// Makes one recording. It depends on the seed, the set and the job alone.
    ///
    /// # Errors
    /// [`Error::Work`] if the simulation refuses a setting.
    pub fn record(self, request: &Request, job: usize) -> Result<Recording, Error> {
        let seed = seed_of(request.seed, &[u64::from(self.number()), job as u64]);
        match self {
            Self::Floor => record::floor::record(request, job, seed),
            Self::Head => record::head::record(request, job, seed),
            Self::Table => record::table::record(request, job, seed),
            Self::Pad => record::pad::record(request, job, seed),
            Self::Corridor => record::corridor::record(request, job, seed),
        }
    }
}
