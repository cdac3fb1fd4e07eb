//! Errors of the layers below, as this program's.

use std::fmt::Display;

use host_sim::Error;

/// A layer below refused a setting or data: work that failed.
pub(crate) fn refused(error: impl Display) -> Error {
    Error::Work(error.to_string())
}

/// Says at the front of failed work which part of the program it was.
pub(crate) fn within(part: &str, error: Error) -> Error {
    match error {
        Error::Work(fault) => Error::Work(format!("{part}: {fault}")),
        other => other,
    }
}
