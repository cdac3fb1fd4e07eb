//! What a shard has come to.

use std::path::Path;

use host_sim::Error;
use host_sim::output::write_whole;
use serde::{Deserialize, Serialize};

/// A shard that has ended well.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShardRow {
    /// Where it ran: `host-sim`, or the board's name.
    pub subject: String,
    /// The scene's name.
    pub scene: String,
    /// The seed in place of the scene's own.
    pub seed: u64,
    /// Simulated hours.
    pub hours: f64,
    /// Ticks.
    pub ticks: u64,
    /// Decisions.
    pub decisions: u64,
    /// Decisions an hour in its first part; on boards parts are one.
    pub first_rate: Option<f64>,
    /// The same in its last part.
    pub last_rate: Option<f64>,
    /// The share of right ones in its first part; nothing: nothing was decided.
    pub first_right: Option<f64>,
    /// The same in its last part.
    pub last_right: Option<f64>,
    /// Touches that were reported.
    pub touches: u64,
    /// Counters that have wrapped.
    pub wrapped: u64,
    /// How long it took, s.
    pub took_s: f64,
}

impl ShardRow {
    /// Writes it to a file of its own.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let written = writer.serialize(self).map_err(Into::into);
        let bytes =
            written.and_then(|()| writer.into_inner().map_err(csv::IntoInnerError::into_error));
        let bytes = bytes.map_err(|error| Error::write(path, error))?;
        write_whole(path, &bytes)
    }
}

/// The row that a shard has left in `path`.
///
/// # Errors
/// [`Error::Input`] if it is no such file.
pub fn row(path: &Path) -> Result<ShardRow, Error> {
    let read = csv::Reader::from_path(path);
    let row = read.and_then(|mut reader| reader.deserialize().next().transpose());
    let row = row.map_err(|error| Error::file(path, error))?;
    row.ok_or_else(|| Error::file(path, "it has no row"))
}

#[cfg(test)]
mod tests {
    use super::{ShardRow, row};

    #[test]
    fn a_row_survives_its_file() {
        let written = ShardRow {
            subject: "host-sim".to_owned(),
            scene: "full".to_owned(),
            seed: 3,
            hours: 6.0,
            ticks: 43_200_000,
            decisions: 9,
            first_rate: Some(1.5),
            last_rate: Some(1.25),
            first_right: Some(0.5),
            last_right: None,
            touches: 70_000,
            wrapped: 1,
            took_s: 0.1,
        };
        let folder = std::env::temp_dir().join(format!("endurance-{}", std::process::id()));
        let path = folder.join("row.csv");
        std::fs::create_dir_all(&folder).expect("a folder");
        written.write(&path).expect("it is written");
        let found = row(&path).expect("it is read");
        std::fs::remove_dir_all(&folder).expect("it is ours");
        assert_eq!(found, written);
    }
}
