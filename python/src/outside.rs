//! What goes wrong outside the simulation, as Python has it: files, memory, interrupts.

use std::path::Path;

use pyo3::exceptions::{PyMemoryError, PyOverflowError, PyValueError};
use pyo3::prelude::*;

/// Ticks after which it is seen whether an interrupt has come: some hundredths of a second.
pub(crate) const HEEDED: u64 = 1 << 13;

/// Python's own exception for the kind of error, with the path.
pub(crate) fn file_error(path: &Path, error: std::io::Error) -> PyErr {
    std::io::Error::new(error.kind(), format!("{}: {error}", path.display())).into()
}

/// A `ValueError`.
pub(crate) fn wrong(fault: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(fault.to_string())
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

/// Every [`HEEDED`] ticks: lets the user's handlers of signals run. Nothing that they may ask for
/// is locked meanwhile.
///
/// # Errors
/// `KeyboardInterrupt`, or what else a handler raises.
pub(crate) fn heed() -> PyResult<()> {
    #[expect(
        clippy::redundant_closure_for_method_calls,
        reason = "the method is of one lifetime, what is asked for of any"
    )]
    Python::attach(|py| py.check_signals())
}

/// What a word stands for.
///
/// # Errors
/// `ValueError` with the words that are allowed.
pub(crate) fn one_of<T: Clone>(name: &str, found: &str, allowed: &[(&str, T)]) -> PyResult<T> {
    let of_it = allowed.iter().find(|(word, _)| *word == found);
    of_it.map(|(_, meant)| meant.clone()).ok_or_else(|| {
        let words: Vec<&str> = allowed.iter().map(|(word, _)| *word).collect();
        let words = words.join(", ");
        wrong(format_args!("{name}: found {found:?}, allowed: {words}"))
    })
}

/// A whole number that was given; a `ValueError` has its range.
pub(crate) fn whole<T: TryFrom<i64>>(name: &str, found: i64) -> PyResult<T> {
    let most = u64::MAX >> (64 - 8 * size_of::<T>()).max(1);
    let refused = |_| wrong(format_args!("{name}: found {found}, allowed: 0 to {most}"));
    found.try_into().map_err(refused)
}

/// The same of a seed, which may be larger.
pub(crate) fn seed(name: &str, given: &Bound<'_, PyAny>) -> PyResult<u64> {
    given.extract().map_err(|error: PyErr| {
        let fault = format_args!("{name}: found {given}, allowed: 0 to {}", u64::MAX);
        let is_beyond = error.is_instance_of::<PyOverflowError>(given.py());
        if is_beyond { wrong(fault) } else { error }
    })
}

/// Whether a number that was given is within its range.
///
/// # Errors
/// `ValueError` with the range.
pub(crate) fn within(name: &str, found: f64, least: f64, most: f64) -> PyResult<()> {
    if (least..=most).contains(&found) {
        return Ok(());
    }
    let range = format_args!("{least} to {most}");
    Err(wrong(format_args!(
        "{name}: found {found}, allowed: {range}"
    )))
}
