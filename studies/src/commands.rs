//! What the commands of the command line do, a file each.

pub mod decisions;
pub mod experiment;
pub mod report;

use std::path::Path;

use host_sim::Error;
use host_sim::output::write_whole;

/// Writes generated files into the folder `out`, or with `check` says whether those that
/// are there are the same. `command` makes `what`. Returns what was done.
fn keep(
    out: &Path,
    files: &[(String, String)],
    check: bool,
    what: &str,
    command: &str,
) -> Result<String, Error> {
    let folder = out.display();
    if check {
        let differs = |(name, text): &&(String, String)| {
            std::fs::read(out.join(name)).map_or(true, |found| found != text.as_bytes())
        };
        let stale: Vec<String> = files
            .iter()
            .filter(differs)
            .map(|(name, _)| out.join(name).display().to_string())
            .collect();
        let stale_files = stale.join(", ");
        return if stale.is_empty() {
            Ok(format!("{folder}: {what} is up to date"))
        } else {
            let fault = format!("out of date: {stale_files}: run {command}");
            Err(Error::Work(fault))
        };
    }
    for (name, text) in files {
        write_whole(&out.join(name), text.as_bytes())?;
    }
    Ok(format!("{folder}: {} files of {what}", files.len()))
}
