//! Scenes for hours: on the PC, whether they end as they began; on the emulated boards, with
//! every counter started just below its wrap, whether they stay the same as on the PC.
//!
//! A week and a day are cut into *shards*: a scene with a seed for some hours, whose row is
//! kept in a file of its own, so that what is interrupted goes on where it stood.

mod on_pc;
mod page;
mod span;

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use host_sim::Error;
use host_sim::output::{self, write_whole};
use serde::{Deserialize, Serialize};

use crate::compare::{Circumstances, compare};
use crate::deployment::flashed;

/// A long run.
#[derive(Debug, Args)]
pub(crate) struct Choice {
    /// The scene file
    scene: PathBuf,
    /// The program that was built for it; none: on the PC
    #[arg(long, value_name = "ELF", requires = "subject")]
    program: Option<PathBuf>,
    /// What the row calls the board
    #[arg(long)]
    subject: Option<String>,
    /// The seed in place of the scene's own, on the PC
    #[arg(long, default_value_t = 1, conflicts_with = "program")]
    seed: u64,
    /// For how many simulated hours
    #[arg(long)]
    hours: f64,
    /// The file of the shard
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

impl Choice {
    pub(crate) fn run(&self) -> Result<(), Error> {
        output::check(&self.out)?;
        let row = match (&self.program, &self.subject) {
            (Some(program), Some(subject)) => on_board(&self.scene, program, subject, self.hours)?,
            _ => on_pc::on_pc(&self.scene, self.seed, self.hours)?,
        };
        row.write(&self.out)
    }
}

pub(crate) fn write_page(shards: &[PathBuf], out: &Path) -> Result<(), Error> {
    let rows: Result<Vec<_>, _> = shards.iter().map(|shard| row(shard)).collect();
    write_whole(out, page::page(&rows?).as_bytes())
}

/// What a shard has come to.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
struct ShardRow {
    subject: String,
    scene: String,
    /// The seed in place of the scene's own.
    seed: u64,
    hours: f64,
    ticks: u64,
    decisions: u64,
    /// Decisions an hour in its first part; on boards parts are one.
    first_rate: Option<f64>,
    last_rate: Option<f64>,
    /// The share of right ones in its first part; nothing: nothing was decided.
    first_right: Option<f64>,
    last_right: Option<f64>,
    touches: u64,
    wrapped: u64,
    took_s: f64,
}

impl ShardRow {
    fn write(&self, path: &Path) -> Result<(), Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let written = writer.serialize(self).map_err(Into::into);
        let bytes =
            written.and_then(|()| writer.into_inner().map_err(csv::IntoInnerError::into_error));
        let bytes = bytes.map_err(|error| Error::write(path, error))?;
        write_whole(path, &bytes)
    }
}

fn row(path: &Path) -> Result<ShardRow, Error> {
    let read = csv::Reader::from_path(path);
    let row = read.and_then(|mut reader| reader.deserialize().next().transpose());
    let row = row.map_err(|error| Error::file(path, error))?;
    row.ok_or_else(|| Error::file(path, "it has no row"))
}

/// Hours of a scene on an emulated board, beside the PC.
/// Every counter starts just below its wrap, and on the PC at zero. Every tick and every decision
/// must be the same, no tick may be missed, and every counter must wrap.
fn on_board(path: &Path, program: &Path, subject: &str, hours: f64) -> Result<ShardRow, Error> {
    let begun = Instant::now();
    let (mut loaded, program) = flashed(path, program)?;
    loaded.scene.duration_s = 3_600.0 * hours;
    let (name, seed) = (loaded.scene.name.clone(), loaded.scene.seed);
    let circumstances = Circumstances {
        wraps: true,
        ..Circumstances::default()
    };
    let agreed = compare(loaded, path, &program, circumstances)?;
    if agreed.missed > 0 {
        let fault = format!("{}: {} ticks missed", path.display(), agreed.missed);
        return Err(Error::Work(fault));
    }
    Ok(ShardRow {
        subject: subject.to_owned(),
        scene: name,
        seed,
        hours,
        ticks: agreed.ticks,
        decisions: agreed.decisions,
        touches: agreed.touches,
        wrapped: agreed.wrapped as u64,
        took_s: begun.elapsed().as_secs_f64(),
        ..ShardRow::default()
    })
}
