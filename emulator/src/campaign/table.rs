//! The table of a shard: a row a run, written as soon as the run is over.

use std::fs::{File, OpenOptions};
use std::io::Read;
use std::path::{Path, PathBuf};

use host_sim::Error;
use host_sim::output;

use super::outcome::RunRow;

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
