//! What can go wrong, and the exit status it means.

use std::path::{Path, PathBuf};

use tactile::name::Shown;

/// Why a command ended early.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The arguments or a file are wrong: exit status 2. One fault a line.
    #[error("{0}")]
    Input(String),
    /// The work itself failed: exit status 1.
    #[error("{0}")]
    Work(String),
    /// A file could not be written: exit status 1.
    #[error("{}: {source}", path.display())]
    Write {
        /// Which file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
}

impl Error {
    /// A given file is wrong or cannot be read; every line of `fault` is prefixed
    /// with the file's name.
    pub fn file(path: &Path, fault: impl std::fmt::Display) -> Self {
        let fault = fault.to_string();
        let name = path.display().to_string();
        let lines = fault
            .lines()
            .map(|line| format!("{}: {}", Shown(&name), Shown(line)));
        Self::Input(lines.collect::<Vec<_>>().join("\n"))
    }

    /// A file could not be written.
    pub fn write(path: &Path, source: std::io::Error) -> Self {
        let path = path.to_owned();
        Self::Write { path, source }
    }

    /// 1 if the work failed, 2 if what was given is wrong.
    pub const fn exit_status(&self) -> u8 {
        match self {
            Self::Input(_) => 2,
            Self::Work(_) | Self::Write { .. } => 1,
        }
    }
}

impl From<scene::Problems> for Error {
    fn from(problems: scene::Problems) -> Self {
        Self::Input(problems.to_string())
    }
}
