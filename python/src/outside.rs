//! What goes wrong outside the simulation, as Python has it: files, memory, interrupts.

use std::path::Path;

use pyo3::exceptions::PyMemoryError;
use pyo3::{PyErr, PyResult, Python};

/// Ticks after which it is seen whether an interrupt has come: some hundredths of a second.
const HEEDED: u64 = 1 << 16;

/// Python's own exception for the kind of error, with the path.
pub(crate) fn file_error(path: &Path, error: std::io::Error) -> PyErr {
    std::io::Error::new(error.kind(), format!("{}: {error}", path.display())).into()
}

/// So many bytes, all zero.
///
/// # Errors
/// `MemoryError` if there are not as many, instead of the end of the process.
pub(crate) fn zeros(bytes: usize) -> PyResult<Vec<u8>> {
    // Only whether they are to be had: the system makes zeros as they are first touched.
    drop(room(bytes)?);
    Ok(vec![0; bytes])
}

/// Room for so many bytes.
///
/// # Errors
/// As [`zeros`].
pub(crate) fn room(bytes: usize) -> PyResult<Vec<u8>> {
    let mut all = Vec::new();
    let reserved = all.try_reserve_exact(bytes);
    reserved.map_err(|_| PyMemoryError::new_err(format!("no room for rows of {bytes} bytes")))?;
    Ok(all)
}

/// Every now and then: whether the user has interrupted, after `ticks` ticks.
///
/// # Errors
/// `KeyboardInterrupt`, or what else the user's handler raises.
pub(crate) fn heed(ticks: u64) -> PyResult<()> {
    if ticks.is_multiple_of(HEEDED) {
        #[expect(
            clippy::redundant_closure_for_method_calls,
            reason = "the method is of one lifetime, what is asked for of any"
        )]
        Python::attach(|py| py.check_signals())?;
    }
    Ok(())
}
