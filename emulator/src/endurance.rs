//! Scenes for hours: on the PC, whether they end as they began; on the emulated boards, with
//! every counter started just below its wrap, whether they stay the same as on the PC.
//!
//! A week and a day are cut into *shards*: a scene with a seed for some hours, whose row is
//! kept in a file of its own, so that what is interrupted goes on where it stood.

mod on_board;
mod on_pc;
mod page;
mod row;
mod span;

use std::path::{Path, PathBuf};

use clap::Args;
use host_sim::Error;
use host_sim::output::{self, write_whole};

/// A long run.
#[derive(Debug, Args)]
pub struct Choice {
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
    /// Makes the long run of a shard, and writes its row.
    ///
    /// # Errors
    /// [`Error::Work`] says what has gone wrong in it, and when.
    pub fn run(&self) -> Result<(), Error> {
        output::check(&self.out)?;
        let row = match (&self.program, &self.subject) {
            (Some(program), Some(subject)) => {
                on_board::on_board(&self.scene, program, subject, self.hours)?
            }
            _ => on_pc::on_pc(&self.scene, self.seed, self.hours)?,
        };
        row.write(&self.out)
    }
}

/// The page of these shards.
///
/// # Errors
/// [`Error::Input`] for a file that is no shard's, [`Error::Write`].
pub fn write_page(shards: &[PathBuf], out: &Path) -> Result<(), Error> {
    let rows: Result<Vec<_>, _> = shards.iter().map(|shard| row::row(shard)).collect();
    write_whole(out, page::page(&rows?).as_bytes())
}
