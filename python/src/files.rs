//! Errors of files as Python has them.

use std::path::Path;

use pyo3::PyErr;

/// Python's own exception for the kind of error, with the path.
pub(crate) fn file_error(path: &Path, error: std::io::Error) -> PyErr {
    std::io::Error::new(error.kind(), format!("{}: {error}", path.display())).into()
}
