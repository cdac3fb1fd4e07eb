//! What was asked for: which experiments, how much of each, on which seeds and rigs.

use std::path::PathBuf;

use host_sim::Error;

use super::request::{Extent, Name, Request};
use crate::rigs::{Rigs, Setting};

/// What was asked for.
#[derive(Debug, Clone)]
pub struct Protocol {
    /// The experiments.
    pub names: Vec<Name>,
    /// How much of each.
    pub extent: Extent,
    /// The first seed, and how many follow each other.
    pub seeds: (u64, u64),
    /// The folder of rigs that differ.
    pub rigs: Option<PathBuf>,
    /// Keys that are set by name.
    pub settings: Vec<Setting>,
    /// Whether recordings are kept beside the data of figures.
    pub keeps_recordings: bool,
}

/// Files by their paths.
pub type Files = Vec<(String, String)>;

impl Protocol {
    /// Its seeds.
    pub(super) fn all_seeds(&self) -> std::ops::Range<u64> {
        let (first, count) = self.seeds;
        first..first.saturating_add(count)
    }

    /// A run of it.
    pub(super) fn request(
        &self,
        seed: u64,
        more: &[Setting],
        is_placebo: bool,
    ) -> Result<Request, Error> {
        let settings = [&self.settings[..], more].concat();
        Ok(Request {
            names: self.names.clone(),
            extent: self.extent,
            seed,
            rigs: Rigs::load(self.rigs.as_deref(), &settings)?,
            is_placebo,
        })
    }
}
