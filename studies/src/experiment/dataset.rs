//! The data sets: what is simulated once and used by one experiment or more.

/// A set of recordings on one rig. Their order is in the seeds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Dataset {
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
    /// One vibrissa of the pad, sample by sample, in the pad's sweeps.
    Vibrissa,
}

impl Dataset {
    /// Its name.
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

/// A job of a data set: what one recording comes of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Job {
    /// Of which set.
    pub(crate) dataset: Dataset,
    /// Which of its jobs, from 0.
    pub(crate) number: usize,
}
