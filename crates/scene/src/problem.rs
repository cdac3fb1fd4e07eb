//! What is wrong with a scene file.

use std::fmt;

use tactile::name::Shown;

/// One problem of a scene file.
///
/// It prints on one line as `file:line: key: what was found; what is allowed`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// The file, as the caller named it, or what was given beside it.
    pub file: String,
    /// Line, counted from 1; `None` when the file could not be read at all, and beside it.
    pub line: Option<usize>,
    /// The key with its section (`head.sides`), a section (`[head]`), or
    /// `TOML syntax`; empty when the file could not be read.
    pub key: String,
    /// What was found there.
    pub found: String,
    /// What is allowed there, with a suggestion where a word is misspelt.
    pub allowed: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // A key that is given beside the file may have several lines.
        for (n, line) in self.file.split('\n').enumerate() {
            f.write_str(if n > 0 { "\n" } else { "" })?;
            Shown(line).fmt(f)?;
        }
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        if !self.key.is_empty() {
            write!(f, ": {}", self.key)?;
        }
        write!(f, ": {}", self.found)?;
        if !self.allowed.is_empty() {
            write!(f, "; {}", self.allowed)?;
        }
        Ok(())
    }
}

impl std::error::Error for Problem {}

/// All problems of a scene file, in the order of its lines; at least one.
///
/// It prints one line a problem, without a newline at the end. Of very many the first are listed,
/// and the others counted.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problems {
    list: Vec<Problem>,
    more: usize,
}

impl Problems {
    pub(crate) fn new(list: Vec<Problem>, more: usize) -> Self {
        Self { list, more }
    }

    /// The problems that are listed, in the order of the file's lines.
    pub fn as_slice(&self) -> &[Problem] {
        &self.list
    }
}

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, problem) in self.list.iter().enumerate() {
            if i > 0 {
                f.write_str("\n")?;
            }
            problem.fmt(f)?;
        }
        if self.more > 0 {
            write!(f, "\n{} more problems", self.more)?;
        }
        Ok(())
    }
}

impl std::error::Error for Problems {}
