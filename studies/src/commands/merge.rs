//! `studies experiment merge`: joins parts and evaluates them.

use std::path::{Path, PathBuf};

use super::experiment::written;
use crate::experiment::{Request, first_line, join};
use crate::rigs::Rigs;
use host_sim::Error;

/// Joins `parts`, which must be all of one request, in any order, and writes
/// what the request in one go would have written, byte for byte.
///
/// # Errors
/// [`Error::Input`] if a part is damaged, of another request, doubled or
/// missing; [`Error::Work`], [`Error::Write`].
pub fn merge(parts: &[PathBuf], rigs: Option<&Path>, out: &Path) -> Result<String, Error> {
    let first = parts
        .first()
        .ok_or_else(|| Error::Input("no part is given".to_owned()))?;
    let line = first_line(first)?;
    let request = Request::from_line(&line, Rigs::load(rigs)?)
        .ok_or_else(|| Error::file(first, format_args!("no request: {line}")))?;
    let recordings = join(parts, &request)?;
    written(&request, &recordings, out)
}
