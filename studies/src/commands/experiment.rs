//! `studies experiment`: records, and evaluates or writes a part.

use std::path::{Path, PathBuf};

use crate::experiment::{
    Extent, Name, Recordings, Request, Shard, jobs, record, report, share, write_part,
};
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
    /// Record only share i of n, into a part file
    #[arg(long, value_name = "i/n")]
    pub shard: Option<Shard>,
    /// The folder of the rigs' files (studies/rigs/*.toml); those built in if none
    #[arg(long, value_name = "DIR")]
    pub rigs: Option<PathBuf>,
    /// Where to write
    #[arg(long, value_name = "DIR", default_value = "out/experiments")]
    pub out: PathBuf,
}

/// Runs experiments. Writes `out/experiments.md` and its pictures, or for a
/// shard `out/NAME-i-of-n.part`. Returns what was done.
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
    if let Some(shard) = options.shard {
        let recordings = record(&request, &share(&request, shard), verbosity)?;
        let Shard { index, count } = shard;
        let name = match request.names.as_slice() {
            [one] => one.text(),
            _ => "all",
        };
        let name = format!("{name}-{index}-of-{count}.part");
        let path = options.out.join(name);
        write_part(&path, &request, &recordings)?;
        return Ok(format!(
            "{}: {} recordings",
            path.display(),
            recordings.len()
        ));
    }
    let recordings = record(&request, &jobs(&request), verbosity)?;
    written(&request, &recordings, &options.out)
}

/// Evaluates recordings and writes the page.
///
/// # Errors
/// [`Error::Work`], [`Error::Write`].
pub(super) fn written(
    request: &Request,
    recordings: &Recordings,
    out: &Path,
) -> Result<String, Error> {
    let files = report(request, recordings)?;
    for (name, text) in &files {
        write_whole(&out.join(name), text.as_bytes())?;
    }
    let page = files.last().map_or("", |(name, _)| name);
    Ok(format!("{}", out.join(page).display()))
}
