//! What was asked for: which experiments, how much of each, on which seeds and rigs.

use std::path::PathBuf;

use super::request::{Extent, Name, Request};
use crate::rigs::{Rigs, Setting};

/// What was asked for.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct Protocol {
    /// Which: lep10, lep12, biotact, pose, psikharpax, or all
    #[arg(required = true, value_parser = named)]
    which: Vec<Named>,
    /// Fewer trials, whisks, contacts, sweeps and runs, two seeds; the same physics
    #[arg(long)]
    pub(super) quick: bool,
    /// The first seed, of which all chance comes
    #[arg(long, default_value_t = 101)]
    pub(super) seed: u64,
    /// How many seeds, one after another: errors are of their mean
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(2..=1000), default_value_t = 5, default_value_if("quick", "true", "2"))]
    pub(super) seeds: u64,
    /// A folder of rigs that differ: files as in studies/rigs, of the keys that are other
    #[arg(long, value_name = "DIR")]
    pub(super) rigs: Option<PathBuf>,
    /// Sets a key of a rig, such as head.motor.kp=0.1; may be given again
    #[arg(long, value_name = "RIG.KEY=VALUE")]
    pub(super) set: Vec<Setting>,
    /// Where to write the page and its pictures
    #[arg(long, value_name = "DIR", default_value = "out/experiments")]
    pub(crate) out: PathBuf,
    /// Where to write the data of every figure, as CSV
    #[arg(long, value_name = "DIR")]
    pub(crate) data: Option<PathBuf>,
    /// Keep every recording there, too
    #[arg(long, requires = "data")]
    pub(super) recordings: bool,
}

/// The experiments of a name: one, or all.
type Named = &'static [Name];

fn named(text: &str) -> Result<Named, String> {
    let place = Name::ALL.iter().position(|name| name.text() == text);
    let one = place.and_then(|place| Name::ALL.get(place..=place));
    let all = (text == "all").then_some(Name::ALL);
    one.or(all).ok_or_else(|| {
        let names: Vec<&str> = Name::ALL.iter().map(|name| name.text()).collect();
        format!("there are {} and all", names.join(", "))
    })
}

impl Protocol {
    /// The experiments, each once, in the order of the page.
    pub(super) fn names(&self) -> Vec<Name> {
        let is_meant = |name: &Name| self.which.iter().any(|named| named.contains(name));
        Name::ALL.iter().copied().filter(is_meant).collect()
    }

    pub(super) fn extent(&self) -> Extent {
        if self.quick {
            Extent::Quick
        } else {
            Extent::Full
        }
    }

    /// Its seeds.
    pub(super) fn all_seeds(&self) -> std::ops::Range<u64> {
        self.seed..self.seed.saturating_add(self.seeds)
    }

    /// A run of it.
    pub(super) fn request(&self, seed: u64, is_placebo: bool) -> anyhow::Result<Request> {
        Ok(Request {
            names: self.names(),
            extent: self.extent(),
            seed,
            rigs: Rigs::load(self.rigs.as_deref(), &self.set)?,
            is_placebo,
        })
    }
}
