//! Faults injected at random times into running scenes, on the PC and on emulated boards,
//! and what becomes of them.
//!
//! Every run is one scene, one fault and one time, all drawn from the run's number: the
//! same number gives the same run. What must hold in every tick of every run is in
//! [`judge`]; how a run is called afterwards is in [`table`].
//!
//! # Glossary
//!
//! - *subject*: where a scene runs: host-sim, or a board's program on its emulated chip;
//! - *undisturbed run*: the same scene without a fault, to which a run is compared;
//! - *shard*: the runs whose numbers leave the same remainder; its rows are kept in a file
//!   of its own, so that what is interrupted goes on where it stood.

mod draw;
mod injection;
mod judge;
mod on_board;
mod page;
mod prepared;
mod subject;
mod table;

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::{Path, PathBuf};

use clap::Args;
use host_sim::Error;
use host_sim::output::write_whole;

pub use injection::Kind;
pub use page::{described, page};
pub use table::{Ending, RunRow, merge, read};

use crate::scenario::Several;
use draw::Plan;
use prepared::Prepared;
use table::{ShardTable, rows};

/// Which runs are made, and where their rows are kept.
#[derive(Debug, Args)]
pub(crate) struct Choice {
    #[command(flatten)]
    several: Several,
    /// A run for every word of RAM of the only scene's program, of which it flips a bit
    #[arg(long, requires = "program")]
    words: bool,
    /// What the rows call it
    #[arg(long, default_value = "host-sim")]
    subject: String,
    /// The number of the first run
    #[arg(long, default_value_t = 0)]
    first: u64,
    /// How many runs; with --words no more than there are words
    #[arg(long, default_value_t = u64::MAX, required_unless_present = "words")]
    runs: u64,
    /// Which shard
    #[arg(long, default_value_t = 0)]
    shard: u64,
    /// Of how many
    #[arg(long, default_value_t = 1)]
    shards: u64,
    /// The table of the shard: rows that it has are not run again
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

impl Choice {
    /// Makes the runs of a shard that its table does not have yet.
    pub(crate) fn run(&self) -> Result<(), Error> {
        let Several { scenes, program } = &self.several;
        let plan = if self.words { Plan::Words } else { Plan::Drawn };
        let mut table = ShardTable::open(&self.out)?;
        let mut prepared = BTreeMap::new();
        for number in self.first..self.first.saturating_add(self.runs) {
            let is_own = number % self.shards.max(1) == self.shard;
            if !is_own || table.done.contains(&number) {
                continue;
            }
            // All scenes in turn, whatever the number of shards.
            let n = (number % scenes.len().max(1) as u64) as usize;
            let scene = match prepared.entry(n) {
                Entry::Occupied(scene) => scene.into_mut(),
                Entry::Vacant(place) => {
                    let scene = scenes.get(n);
                    let scene = scene.ok_or_else(|| Error::Input("no scene to run".to_owned()))?;
                    place.insert(Prepared::new(scene, program.get(n).map(PathBuf::as_path))?)
                }
            };
            if self.words && number >= scene.words() {
                break;
            }
            table.add(&scene.run(&self.subject, number, plan)?)?;
        }
        Ok(())
    }
}

/// Makes the page of these tables, if it is wanted; how many runs there are.
pub(crate) fn reliability(tables: &[PathBuf], out: Option<&Path>) -> Result<String, Error> {
    let tables: Result<Vec<_>, Error> = tables.iter().map(|path| rows(path)).collect();
    let rows = merge(tables?)?;
    if let Some(out) = out {
        write_whole(out, page(&rows).map_err(Error::Work)?.as_bytes())?;
    }
    let harmful = rows.iter().filter(|row| row.outcome == Ending::Harmful);
    let harmful: Vec<String> = harmful.map(described).collect();
    if harmful.is_empty() {
        Ok(format!("{} runs, none harmful", rows.len()))
    } else {
        Err(Error::Work(harmful.join("\n")))
    }
}
