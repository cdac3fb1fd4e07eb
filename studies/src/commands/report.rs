//! `studies report`: the accuracy report, written or checked.

use std::path::Path;

use crate::accuracy::{LongRun, report as measure};
use crate::refused::within;
use host_sim::Error;
use host_sim::output::write_whole;
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
    if check {
        let differs = |(name, text): &&(String, String)| {
            std::fs::read(out.join(name)).map_or(true, |found| found != text.as_bytes())
        };
        let stale: Vec<String> = files
            .iter()
            .filter(differs)
            .map(|(name, _)| out.join(name).display().to_string())
            .collect();
        let (folder, stale_files) = (out.display(), stale.join(", "));
        return if stale.is_empty() {
            Ok(format!("{folder}: the accuracy report is up to date"))
        } else {
            let fault = format!("out of date: {stale_files}: run studies report");
            Err(Error::Work(fault))
        };
    }
    for (name, text) in &files {
        write_whole(&out.join(name), text.as_bytes())?;
    }
    Ok(format!(
        "{}: {} files of the accuracy report",
        out.display(),
        files.len()
    ))
}
