//! `studies report`: the accuracy report, written or checked.

use std::path::Path;

use crate::accuracy::{LongRun, report as measure};
use crate::commands::keep;
use crate::refused::within;
use host_sim::Error;
use host_sim::progress::Verbosity;

/// Writes the report into the folder `out`, or with `check` says whether what
/// is there is up to date. Returns what was done.
///
/// # Errors
/// [`Error::Work`] if it is out of date, [`Error::Input`] for a broken table of
/// results, [`Error::Write`].
pub fn report(
    out: &Path,
    long_run: LongRun,
    check: bool,
    verbosity: Verbosity,
) -> Result<String, Error> {
    let files = measure(out, long_run, verbosity);
    let files = files.map_err(|error| within("the accuracy report", error))?;
    keep(out, &files, check, "the accuracy report", "studies report")
}
