//! What was asked for: which experiments, how much of each, on which seeds and rigs.

use std::path::PathBuf;
use std::str::FromStr;

use super::request::{Arm, Extent, Name, Request};
use crate::rigs::{Rigs, Setting};

/// What was asked for.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct Asked {
    /// Which: lep10, lep12, biotact, pose, psikharpax, or all
    #[arg(required = true, value_parser = named)]
    which: Vec<Named>,
    /// Fewer trials, whisks, contacts, sweeps and runs, two seeds, no changes, no placebo of
    /// labels; the same physics
    #[arg(long)]
    pub(super) quick: bool,
    /// One of them cut short as by --quick, on so many seeds; may be given again
    #[arg(long, value_name = "NAME=SEEDS")]
    pub(super) short: Vec<Short>,
    /// The first seed, of which all chance comes
    #[arg(long, default_value_t = 101)]
    pub(super) seed: u64,
    /// How many seeds, one after another: errors are of their mean
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(2..=1000), default_value_t = 5, default_value_if("quick", "true", "2"))]
    pub(super) seeds: u64,
    /// On how many seeds each change of what is chosen is tried, cut short; 0: on none
    #[arg(
        long,
        value_name = "N",
        default_value_t = 3,
        default_value_if("quick", "true", "0")
    )]
    pub(super) changes: u64,
    /// A folder of rigs that differ: files as in studies/rigs, of the keys that are other
    #[arg(long, value_name = "DIR")]
    pub(super) rigs: Option<PathBuf>,
    /// Sets a key of a rig, such as head.motor.kp=0.1; may be given again
    #[arg(long, value_name = "RIG.KEY=VALUE")]
    pub(super) set: Vec<Setting>,
    /// Where to write the page and its pictures
    #[arg(long, value_name = "DIR", default_value = "out/experiments")]
    pub(super) out: PathBuf,
    /// The name of the page there
    #[arg(long, value_name = "FILE", default_value = "experiments.md")]
    pub(super) page: String,
    /// Where to write the data of every figure, as CSV
    #[arg(long, value_name = "DIR")]
    pub(super) data: Option<PathBuf>,
    /// Keep every recording there, too, as in the papers
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
        let names: Vec<String> = Name::ALL.iter().map(|name| name.text()).collect();
        format!("there are {} and all", names.join(", "))
    })
}

#[derive(Debug, Clone)]
pub(super) struct Short {
    names: Named,
    seeds: u64,
    pub(super) text: String,
}

impl FromStr for Short {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let wrong = || "allowed: NAME=SEEDS, of two seeds or more".to_owned();
        let (name, seeds) = text.split_once('=').ok_or_else(wrong)?;
        let seeds = seeds
            .parse()
            .ok()
            .filter(|seeds| (2..=1000).contains(seeds));
        Ok(Self {
            seeds: seeds.ok_or_else(wrong)?,
            names: named(name)?,
            text: text.to_owned(),
        })
    }
}

/// Experiments on the same recordings, how much of them, and on which seeds.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Part {
    pub(super) names: Vec<Name>,
    pub(super) extent: Extent,
    pub(super) seeds: std::ops::Range<u64>,
}

impl Asked {
    pub(super) fn arms(&self) -> &'static [Arm] {
        if self.quick { Arm::QUICK } else { Arm::ALL }
    }

    pub(super) fn names(&self) -> Vec<Name> {
        let is_meant = |name: &Name| self.which.iter().any(|named| named.contains(name));
        Name::ALL.iter().copied().filter(is_meant).collect()
    }

    /// The experiments in parts, in the order of the page.
    pub(super) fn parts(&self) -> Vec<Part> {
        let mut parts: Vec<Part> = Vec::new();
        for name in self.names() {
            let short = self.short.iter().find(|short| short.names.contains(&name));
            let is_short = self.quick || short.is_some();
            let seeds = short.map_or(self.seeds, |short| short.seeds);
            let part = Part {
                names: vec![name],
                extent: [Extent::FULL, Extent::QUICK][usize::from(is_short)],
                seeds: self.seed..self.seed.saturating_add(seeds),
            };
            match parts.last_mut() {
                Some(last) if last.is_recorded_with(&part) => last.names.push(name),
                _ => parts.push(part),
            }
        }
        parts
    }

    /// The seeds on which changes are tried, behind all others.
    pub(super) fn seeds_of_changes(&self) -> std::ops::Range<u64> {
        let ends = self.parts().into_iter().map(|part| part.seeds.end);
        let first = ends.max().unwrap_or(self.seed);
        first..first.saturating_add(self.changes)
    }

    /// By an arm; or as in the papers, cut short and with the keys of a change.
    pub(super) fn request(
        &self,
        part: &Part,
        seed: u64,
        arm: Arm,
        change: Option<&[String]>,
    ) -> anyhow::Result<Request> {
        let kept = arm.protocol.keys().iter().copied();
        let changed = change.into_iter().flatten().map(String::as_str);
        Ok(Request {
            names: part.names.clone(),
            extent: change.map_or(part.extent, |_| Extent::QUICK),
            seed,
            rigs: self.rigs_with(kept.chain(changed))?,
            arm,
            is_whole: change.is_none() && arm == Arm::MAIN,
        })
    }

    /// The rigs with some keys, and with those that were asked for after them.
    fn rigs_with<'k>(&self, keys: impl Iterator<Item = &'k str>) -> anyhow::Result<Rigs> {
        let keys = keys.map(str::parse);
        let keys: Result<Vec<Setting>, String> = keys.collect();
        let mut settings = keys.map_err(anyhow::Error::msg)?;
        settings.extend(self.set.iter().cloned());
        Ok(Rigs::load(self.rigs.as_deref(), &settings)?)
    }
}

impl Part {
    fn is_recorded_with(&self, other: &Self) -> bool {
        let of = |part: &Self| (part.names[0].datasets(), part.extent, part.seeds.clone());
        of(self) == of(other)
    }
}
