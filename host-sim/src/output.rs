//! Files that are written completely or not at all: to a temporary file in the
//! same folder, which is renamed when it is complete.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::Error;

/// A file being written. Dropped before [`Output::finish`], it leaves nothing behind.
#[derive(Debug)]
pub struct Output {
    target: PathBuf,
    partial: PathBuf,
    writer: Option<BufWriter<File>>,
}

impl Output {
    /// Opens a file for `path`, and creates its folder if necessary.
    ///
    /// # Errors
    /// [`Error::Input`] if `path` cannot name a file: it is a folder, or
    /// one of its parents is a file. [`Error::Write`] if the folder or the file
    /// cannot be created for another reason.
    pub fn create(path: &Path) -> Result<Self, Error> {
        use io::ErrorKind::{AlreadyExists, InvalidFilename, NotADirectory};
        let wrong = |source: io::Error| match source.kind() {
            AlreadyExists | NotADirectory => {
                Error::file(path, "a file is where its folder would be")
            }
            InvalidFilename => Error::file(path, source),
            _ => Error::write(path, source),
        };
        let name = path
            .file_name()
            .ok_or_else(|| Error::file(path, "not a file name"))?;
        if path.is_dir() {
            return Err(Error::file(path, "is a folder, not a file"));
        }
        if let Some(folder) = path
            .parent()
            .filter(|folder| !folder.as_os_str().is_empty())
        {
            fs::create_dir_all(folder).map_err(wrong)?;
        }
        let mut partial_name = name.to_owned();
        partial_name.push(format!(".{}.partial", std::process::id()));
        let partial = path.with_file_name(partial_name);
        let file = File::create(&partial).map_err(wrong)?;
        Ok(Self {
            target: path.to_owned(),
            partial,
            writer: Some(BufWriter::new(file)),
        })
    }

    /// Renames the complete file to its path.
    ///
    /// # Errors
    /// [`Error::Write`] if what was written did not reach the disk.
    pub fn finish(mut self) -> Result<(), Error> {
        let written = match self.writer.take() {
            Some(writer) => writer
                .into_inner()
                .map_err(io::IntoInnerError::into_error)
                .map(drop),
            None => Ok(()),
        };
        written
            .and_then(|()| fs::rename(&self.partial, &self.target))
            .map_err(|source| Error::write(&self.target, source))
    }

    /// Writes all there is to write, and finishes.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn whole(mut self, bytes: &[u8]) -> Result<(), Error> {
        let written = self.write_all(bytes);
        written.map_err(|source| self.failed(source))?;
        self.finish()
    }

    /// The error of a failed write to this file.
    pub fn failed(&self, source: io::Error) -> Error {
        Error::write(&self.target, source)
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.writer {
            Some(writer) => writer.write(bytes),
            None => Err(io::ErrorKind::BrokenPipe.into()),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.as_mut().map_or(Ok(()), Write::flush)
    }
}

impl Drop for Output {
    fn drop(&mut self) {
        // After a successful rename there is nothing to remove; nothing can be
        // done here about a temporary file that cannot be removed.
        drop(self.writer.take());
        let _ = fs::remove_file(&self.partial);
    }
}

/// Writes `bytes` to `path`, completely or not at all.
///
/// # Errors
/// [`Error::Write`].
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    Output::create(path)?.whole(bytes)
}

#[cfg(test)]
mod tests {
    use super::{Output, write_whole};
    use std::fs;
    use std::io::Write;

    #[test]
    fn an_unfinished_file_leaves_nothing_and_spares_the_old_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/er/trace.csv");
        write_whole(&path, b"old").unwrap();
        let mut output = Output::create(&path).unwrap();
        output.write_all(b"half").unwrap();
        drop(output);
        assert_eq!(fs::read(&path).unwrap(), b"old");
        write_whole(&path, b"new").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        let left: Vec<_> = fs::read_dir(path.parent().unwrap()).unwrap().collect();
        assert_eq!(left.len(), 1, "{left:?}");
    }

    #[test]
    fn a_folder_in_the_way_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let error = write_whole(folder.path(), b"x").unwrap_err();
        assert_eq!(error.exit_status(), 2);
    }
}
