//! `studies experiment`: records, and evaluates or writes a part.

use std::path::{Path, PathBuf};

use crate::experiment::{
    Extent, Name, Recordings, Request, Shard, jobs, record, report, share, write_part,
};
use crate::rigs::Rigs;
use host_sim::Error;
use host_sim::output::write_whole;
use host_sim::progress::Verbosity;

/// What the command line asks for.
#[derive(Debug, Clone)]
pub struct Asked {
    /// The experiments.
    pub names: Vec<Name>,
    /// Less of each.
    pub quick: bool,
    /// All chance comes from it.
    pub seed: u64,
    /// Record this share only.
    pub shard: Option<Shard>,
    /// The folder of the rigs' files; the rigs that are built in if none.
    pub rigs: Option<PathBuf>,
    /// Where to write.
    pub out: PathBuf,
}

/// Runs experiments. Writes `out/experiments.md` and its pictures, or for a
/// shard `out/NAME-i-of-n.part`. Returns what was done.
///
/// # Errors
/// [`Error::Input`] for a bad rig, [`Error::Work`], [`Error::Write`].
pub fn experiment(asked: &Asked, verbosity: Verbosity) -> Result<String, Error> {
    let request = Request {
        names: asked.names.clone(),
        extent: if asked.quick {
            Extent::Quick
        } else {
            Extent::Full
        },
        seed: asked.seed,
        rigs: Rigs::load(asked.rigs.as_deref())?,
    };
    if let Some(shard) = asked.shard {
        let recordings = record(&request, &share(&request, shard), verbosity)?;
        let names: Vec<&str> = request.names.iter().map(|name| name.text()).collect();
        let Shard { index, count } = shard;
        let name = match names.as_slice() {
            [one] => format!("{one}-{index}-of-{count}.part"),
            _ => format!("all-{index}-of-{count}.part"),
        };
        let path = asked.out.join(name);
        write_part(&path, &request, &recordings)?;
        return Ok(format!(
            "{}: {} recordings",
            path.display(),
            recordings.len()
        ));
    }
    let recordings = record(&request, &jobs(&request), verbosity)?;
    written(&request, &recordings, &asked.out)
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
