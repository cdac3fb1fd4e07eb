//! `studies decisions`: the page of decisions, written or checked.

use std::path::Path;

use crate::commands::keep;
use crate::decisions::{Extent, Folders, page};
use crate::refused::within;
use host_sim::Error;
use host_sim::progress::Verbosity;

/// Writes the page, its table and its pictures into the folder `out`, or with `check` says
/// whether what is there is up to date. `terrain` has the recordings of a robot. Returns
/// what was done.
///
/// # Errors
/// [`Error::Work`] if it is out of date, [`Error::Input`] for a recording that is missing
/// or broken, [`Error::Write`].
pub fn decisions(
    out: &Path,
    terrain: &Path,
    extent: &Extent,
    check: bool,
    verbosity: Verbosity,
) -> Result<String, Error> {
    let folders = Folders { docs: out, terrain };
    let files = page(folders, extent, verbosity);
    let files = files.map_err(|error| within("the page of decisions", error))?;
    keep(
        out,
        &files,
        check,
        "the page of decisions",
        "studies decisions",
    )
}
