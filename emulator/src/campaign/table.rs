//! What a run has come to, and the table of a shard: a row a run, written as soon as the run is over.

use std::fs::{File, OpenOptions};
use std::io::Read;
use std::path::{Path, PathBuf};

use host_sim::Error;
use host_sim::output;
use serde::{Deserialize, Serialize};

use super::injection::Kind;
use super::judge::Harm;

/// How a run is called.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Ending {
    /// In the end the whiskers move and decide as in the undisturbed run.
    Masked,
    /// The module has noticed it: a fault, a line of the log, or a reset.
    Noticed,
    /// It moves or decides otherwise, and has not noticed it.
    Silent,
    /// What must hold in every tick did not.
    Harmful,
    /// The emulated chip is not modelled beyond this point.
    Unfollowed,
}

/// A run, as it stands in the table of its shard.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunRow {
    /// Where it ran: `host-sim`, or the board's name.
    pub subject: String,
    /// Its number, from which it can be repeated.
    pub run: u64,
    /// The scene's name.
    pub scene: String,
    /// What was injected.
    pub kind: Kind,
    /// What was injected beside it.
    pub and: Option<Kind>,
    /// Before which tick, counted from 1.
    pub start: u64,
    /// For how many ticks; nothing: to the end.
    pub ticks: Option<u64>,
    /// How it is called.
    pub outcome: Ending,
    /// Why, or what was noticed first.
    pub reason: String,
    /// The word of RAM or the register that was changed.
    pub changed: Option<String>,
    /// From the injection to what was noticed first, ms.
    pub noticed_ms: Option<f64>,
}

#[derive(Debug, Default)]
pub(super) struct Findings {
    pub(super) harm: Option<(u64, Harm)>,
    /// The tick of what was noticed first after the injection, and what it was.
    pub(super) noticed: Option<(u64, String)>,
    pub(super) unfollowed: Option<String>,
    pub(super) difference: Option<&'static str>,
}

impl Findings {
    pub(super) const fn is_over(&self) -> bool {
        self.harm.is_some() || self.unfollowed.is_some()
    }

    pub(super) fn verdict(&self) -> (Ending, String) {
        if let Some((tick, harm)) = &self.harm {
            return (Ending::Harmful, format!("{harm}, tick {tick}"));
        }
        if let Some(what) = &self.unfollowed {
            return (Ending::Unfollowed, what.clone());
        }
        if let Some((_, what)) = &self.noticed {
            return (Ending::Noticed, what.clone());
        }
        match self.difference {
            Some(what) => (Ending::Silent, what.to_owned()),
            None => (Ending::Masked, String::new()),
        }
    }
}

#[derive(Debug)]
pub(super) struct ShardTable {
    path: PathBuf,
    writer: csv::Writer<File>,
    pub(super) done: Vec<u64>,
}

impl ShardTable {
    pub(super) fn open(path: &Path) -> Result<Self, Error> {
        output::check(path)?;
        let done = if path.exists() {
            rows(path)?.into_iter().map(|row| row.run).collect()
        } else {
            Vec::new()
        };
        let refused = |error| Error::write(path, error);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(refused)?;
        }
        let file = OpenOptions::new().create(true).append(true).open(path);
        let file = file.map_err(refused)?;
        // A table with rows has its header.
        let is_new = file.metadata().map_err(refused)?.len() == 0;
        let writer = csv::WriterBuilder::new()
            .has_headers(is_new)
            .from_writer(file);
        Ok(Self {
            path: path.to_owned(),
            writer,
            done,
        })
    }

    pub(super) fn add(&mut self, row: &RunRow) -> Result<(), Error> {
        let written = self.writer.serialize(row);
        let written = written.and_then(|()| self.writer.flush().map_err(Into::into));
        written.map_err(|error| Error::write(&self.path, error.into()))
    }
}

pub(super) fn rows(path: &Path) -> Result<Vec<RunRow>, Error> {
    let read = File::open(path).map_err(csv::Error::from).and_then(read);
    read.map_err(|error| Error::file(path, error))
}

/// The rows of a table.
///
/// # Errors
/// What is wrong with the first that is none.
pub fn read(table: impl Read) -> Result<Vec<RunRow>, csv::Error> {
    csv::Reader::from_reader(table).deserialize().collect()
}

/// The rows of several tables, by subject and number.
///
/// # Errors
/// [`Error::Input`] if a run stands there twice.
pub fn merge(tables: impl IntoIterator<Item = Vec<RunRow>>) -> Result<Vec<RunRow>, Error> {
    let mut rows: Vec<RunRow> = tables.into_iter().flatten().collect();
    let key = |row: &RunRow| (row.subject.clone(), row.run);
    rows.sort_by_cached_key(key);
    match rows.array_windows().find(|[a, b]| key(a) == key(b)) {
        Some([twice, _]) => Err(Error::Input(format!(
            "run {} of {} stands in the tables twice",
            twice.run, twice.subject
        ))),
        None => Ok(rows),
    }
}
