//! `studies experiment`: records, evaluates and writes the page.

use std::path::{Path, PathBuf};

use host_sim::Error;
use host_sim::output::write_whole;
use host_sim::progress::Verbosity;

use crate::experiment::{Extent, Files, Name, Protocol, run};
use crate::rigs::Setting;

/// How an experiment is run.
#[derive(Debug, Clone, clap::Args)]
pub struct Options {
    /// Fewer trials, whisks, contacts, sweeps and runs, two seeds; the same physics, no changes
    #[arg(long)]
    pub quick: bool,
    /// The first seed, of which all chance comes
    #[arg(long, default_value_t = 101)]
    pub seed: u64,
    /// How many seeds, one after another: errors are of their mean
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(2..=1000), default_value_t = 5, default_value_if("quick", "true", "2"))]
    pub seeds: u64,
    /// A folder of rigs that differ: files as in studies/rigs, of the keys that are other
    #[arg(long, value_name = "DIR")]
    pub rigs: Option<PathBuf>,
    /// Sets a key of a rig, such as head.motor.kp=0.1; may be given again
    #[arg(long, value_name = "RIG.KEY=VALUE")]
    pub set: Vec<Setting>,
    /// Where to write the page and its pictures
    #[arg(long, value_name = "DIR", default_value = "out/experiments")]
    pub out: PathBuf,
    /// Where to write the data of every figure, as CSV
    #[arg(long, value_name = "DIR")]
    pub data: Option<PathBuf>,
    /// Keep every recording there, too
    #[arg(long, requires = "data")]
    pub recordings: bool,
}

/// Runs experiments. Writes `out/experiments.md` and its pictures. Returns what
/// was done.
///
/// # Errors
/// [`Error::Input`] for a bad rig or setting, [`Error::Work`], [`Error::Write`].
pub fn experiment(
    names: Vec<Name>,
    options: &Options,
    verbosity: Verbosity,
) -> Result<String, Error> {
    let protocol = Protocol {
        names,
        extent: if options.quick {
            Extent::Quick
        } else {
            Extent::Full
        },
        seeds: (options.seed, options.seeds),
        rigs: options.rigs.clone(),
        settings: options.set.clone(),
        keeps_recordings: options.recordings,
    };
    let write = |folder: &Path, files: &Files| {
        let mut all = files.iter();
        all.try_for_each(|(name, text)| write_whole(&folder.join(name), text.as_bytes()))
    };
    let files = run(&protocol, verbosity, &mut |data| match &options.data {
        Some(folder) => write(folder, data),
        None => Ok(()),
    })?;
    write(&options.out, &files)?;
    let page = files.last().map_or("", |(name, _)| name);
    Ok(format!("{}", options.out.join(page).display()))
}
