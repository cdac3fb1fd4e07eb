//! Generated documents: written by commands, never by hand.

use std::fs;

use crate::run::{Fault, top};

/// Writes every generated document, or checks that they are up to date.
///
/// # Errors
/// If a file cannot be written, or, checking, differs.
pub(crate) fn all(check: bool) -> Result<(), Fault> {
    document("docs/scenes.md", &scene::reference(), check)
}

fn document(name: &str, text: &str, check: bool) -> Result<(), Fault> {
    let path = top().join(name);
    let wrong = |error| format!("{name}: {error}");
    if !check {
        return fs::write(&path, text).map_err(wrong);
    }
    if fs::read_to_string(&path).map_err(wrong)? == text {
        Ok(())
    } else {
        Err(format!("{name} is out of date: run cargo xtask docs"))
    }
}
