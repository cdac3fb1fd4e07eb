//! What a shard has come to.

use std::path::Path;

use host_sim::Error;
use host_sim::output::write_whole;
use serde::{Deserialize, Serialize};

#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct ShardRow {
    pub(super) subject: String,
    pub(super) scene: String,
    /// The seed in place of the scene's own.
    pub(super) seed: u64,
    pub(super) hours: f64,
    pub(super) ticks: u64,
    pub(super) decisions: u64,
    /// Decisions an hour in its first part; on boards parts are one.
    pub(super) first_rate: Option<f64>,
    pub(super) last_rate: Option<f64>,
    /// The share of right ones in its first part; nothing: nothing was decided.
    pub(super) first_right: Option<f64>,
    pub(super) last_right: Option<f64>,
    pub(super) touches: u64,
    pub(super) wrapped: u64,
    pub(super) took_s: f64,
}

impl ShardRow {
    pub(super) fn write(&self, path: &Path) -> Result<(), Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let written = writer.serialize(self).map_err(Into::into);
        let bytes =
            written.and_then(|()| writer.into_inner().map_err(csv::IntoInnerError::into_error));
        let bytes = bytes.map_err(|error| Error::write(path, error))?;
        write_whole(path, &bytes)
    }
}

pub(super) fn row(path: &Path) -> Result<ShardRow, Error> {
    let read = csv::Reader::from_path(path);
    let row = read.and_then(|mut reader| reader.deserialize().next().transpose());
    let row = row.map_err(|error| Error::file(path, error))?;
    row.ok_or_else(|| Error::file(path, "it has no row"))
}
