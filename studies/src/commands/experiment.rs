//! `studies experiment`: records, evaluates and writes the page.

use std::path::PathBuf;

use crate::experiment::{Extent, Name, Request, jobs, record, report};
use crate::rigs::Rigs;
use host_sim::Error;
use host_sim::output::write_whole;
use host_sim::progress::Verbosity;

/// How an experiment is run.
#[derive(Debug, Clone, clap::Args)]
pub struct Options {
    /// Fewer trials, whisks, contacts, sweeps and runs; the same physics
    #[arg(long)]
    pub quick: bool,
    /// All chance comes from it
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// The folder of the rigs' files (studies/rigs/*.toml); those built in if none
    #[arg(long, value_name = "DIR")]
    pub rigs: Option<PathBuf>,
    /// Where to write
    #[arg(long, value_name = "DIR", default_value = "out/experiments")]
    pub out: PathBuf,
}

/// Runs experiments. Writes `out/experiments.md` and its pictures. Returns what
/// was done.
///
/// # Errors
/// [`Error::Input`] for a bad rig, [`Error::Work`], [`Error::Write`].
pub fn experiment(
    names: Vec<Name>,
    options: &Options,
    verbosity: Verbosity,
) -> Result<String, Error> {
    let request = Request {
        names,
        extent: if options.quick {
            Extent::Quick
        } else {
            Extent::Full
        },
        seed: options.seed,
        rigs: Rigs::load(options.rigs.as_deref())?,
    };
    let recordings = record(&request, &jobs(&request), verbosity)?;
    let files = report(&request, &recordings)?;
    for (name, text) in &files {
        write_whole(&options.out.join(name), text.as_bytes())?;
    }
    let page = files.last().map_or("", |(name, _)| name);
    Ok(format!("{}", options.out.join(page).display()))
}
