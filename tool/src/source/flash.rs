//! The flash that scenes and models are deployed to, kept in a file: a simulated module, of which
//! it keeps the model alone, and an emulated chip end with the program, a board on the bench does
//! not.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use host_sim::Error;
use host_sim::output::write_whole;
use scene::file;

const ERASED: u8 = 0xFF;

/// Such a file, or flash that is not kept.
#[derive(Debug)]
pub(crate) struct Flash {
    path: Option<PathBuf>,
    contents: Vec<u8>,
}

impl Flash {
    /// What the file has; nothing where there is none yet.
    pub(crate) fn open(path: Option<&Path>) -> Result<Self, Error> {
        let path = path.map(Path::to_owned);
        let Some(file) = &path else {
            return Ok(Self {
                path,
                contents: Vec::new(),
            });
        };
        let contents = match file::read(file, file::BINARY_BYTES) {
            Err(error) if error.kind() == ErrorKind::NotFound => Vec::new(),
            read => read.map_err(|error| Error::file(file, error))?,
        };
        Ok(Self { path, contents })
    }

    /// The same for a board with so many bytes of it: erased, and written to the file, if that
    /// was not there.
    pub(super) fn of_size(mut self, bytes: usize) -> Result<Self, Error> {
        if self.contents.is_empty() {
            self.store(&vec![ERASED; bytes])?;
        }
        match &self.path {
            Some(path) if self.contents.len() != bytes => {
                let found = self.contents.len();
                let fault = format!(
                    "found {found} bytes, allowed: {bytes}, which this module has; is it of \
                     another one?"
                );
                Err(Error::file(path, fault))
            }
            _ => Ok(self),
        }
    }

    pub(crate) fn contents(&self) -> &[u8] {
        &self.contents
    }

    pub(super) const fn is_kept(&self) -> bool {
        self.path.is_some()
    }

    pub(super) fn name(&self) -> &Path {
        self.path.as_deref().unwrap_or(Path::new("flash"))
    }

    pub(crate) fn store(&mut self, contents: &[u8]) -> Result<(), Error> {
        self.contents = contents.to_vec();
        let path = self.path.as_deref();
        path.map_or(Ok(()), |path| write_whole(path, contents))
    }

    /// Keeps a model, as a board would be written: the rest is erased.
    pub(super) fn program(&mut self, model: &[u8]) -> Result<(), Error> {
        let mut contents = model.to_vec();
        contents.resize(self.contents.len(), ERASED);
        self.store(&contents)
    }
}
