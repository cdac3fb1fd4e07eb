//! The classifier's arithmetic, chosen from measured error.

use crate::Error;

/// Appends the section to `out`. Returns its pictures: file name and SVG.
///
/// # Errors
/// None yet.
#[allow(clippy::unnecessary_wraps, reason = "the measurement is still to come")]
pub(crate) fn section(_out: &mut String) -> Result<Vec<(String, String)>, Error> {
    Ok(Vec::new())
}
