//! Files that are written completely or not at all: to a temporary file in the
//! same folder, which is renamed when it is complete.
//!
//! Only regular files are written. A rename would put one in the place of a device, a
//! pipe or a link, so that such a path is refused before any work begins.

mod partial;

use std::fs::{self, File, FileType};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::Error;
use partial::Partial;
pub use partial::remove_on_interrupt;

const STDOUT: &str = "-";

/// Whether `path` means standard output.
pub fn is_stdout(path: &Path) -> bool {
    path.as_os_str() == STDOUT
}

/// A file being written. Dropped before [`Output::finish`], it leaves nothing behind.
#[derive(Debug)]
pub struct Output {
    target: PathBuf,
    sink: Sink,
}

#[derive(Debug)]
enum Sink {
    File(BufWriter<File>, Partial),
    Stdout(BufWriter<io::Stdout>),
}

impl Output {
    /// Opens a file for `path`, and creates its folder if necessary.
    ///
    /// # Errors
    /// [`Error::Input`] if `path` cannot name a file: see [`check`]; or if one of its parents is a
    /// file. [`Error::Write`] if the folder or the file cannot be created for another reason.
    pub fn create(path: &Path) -> Result<Self, Error> {
        use io::ErrorKind::{AlreadyExists, InvalidFilename, NotADirectory};
        let wrong = |source: io::Error| match source.kind() {
            AlreadyExists | NotADirectory => {
                Error::file(path, "a file is where its folder would be")
            }
            InvalidFilename => Error::file(path, source),
            _ => Error::write(path, source),
        };
        check(path)?;
        if let Some(folder) = path
            .parent()
            .filter(|folder| !folder.as_os_str().is_empty())
        {
            fs::create_dir_all(folder).map_err(wrong)?;
        }
        let (file, partial) = Partial::create(path).map_err(wrong)?;
        let sink = Sink::File(BufWriter::new(file), partial);
        let target = path.to_owned();
        Ok(Self { target, sink })
    }

    /// The same, but that `-` is standard output: for tables, which a pipe may take. It has
    /// them as they come, so that nothing takes them back.
    ///
    /// # Errors
    /// As [`Output::create`].
    pub fn create_or_stdout(path: &Path) -> Result<Self, Error> {
        if !is_stdout(path) {
            return Self::create(path);
        }
        let target = PathBuf::from("standard output");
        let sink = Sink::Stdout(BufWriter::new(io::stdout()));
        Ok(Self { target, sink })
    }

    /// Renames the complete file to its path.
    ///
    /// # Errors
    /// [`Error::Write`] if what was written did not reach the disk, [`Error::Input`] if
    /// something else than a file has come to its path meanwhile.
    pub fn finish(self) -> Result<(), Error> {
        let Self { target, sink } = self;
        let written = match sink {
            Sink::Stdout(mut writer) => unless_closed(writer.flush(), ()),
            Sink::File(writer, partial) => {
                check(&target)?;
                let written = writer.into_inner().map_err(io::IntoInnerError::into_error);
                // Closed before it is renamed.
                written.map(drop).and_then(|()| partial.rename(&target))
            }
        };
        written.map_err(|source| Error::write(&target, source))
    }

    /// Writes all there is to write, and finishes.
    ///
    /// # Errors
    /// As [`Output::finish`].
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

/// What came of writing to standard output; `done` where whoever read it has read enough.
pub(crate) fn unless_closed<T>(written: io::Result<T>, done: T) -> io::Result<T> {
    match written {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(done),
        written => written,
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.sink {
            Sink::File(writer, _) => writer.write(bytes),
            Sink::Stdout(writer) => unless_closed(writer.write(bytes), bytes.len()),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.sink {
            Sink::File(writer, _) => writer.flush(),
            Sink::Stdout(writer) => unless_closed(writer.flush(), ()),
        }
    }
}

/// Whether `path` can name a regular file to write: there is none yet, or a regular one.
/// To be asked before work that ends with [`write_whole`].
///
/// # Errors
/// [`Error::Input`] says what is there instead: a folder, a link, a device, a pipe; or that
/// standard output is not to be had here.
pub fn check(path: &Path) -> Result<(), Error> {
    if is_stdout(path) {
        let fault = "standard output is not for this; name a file (./- for one of that name)";
        return Err(Error::file(path, fault));
    }
    if path.file_name().is_none() {
        return Err(Error::file(path, "not a file name"));
    }
    // If the path cannot be looked at, creating it reports why.
    if let Ok(found) = fs::symlink_metadata(path)
        && !found.is_file()
    {
        let what = kind(found.file_type());
        let fault = format!("is {what}, not a regular file; name one, or a new one");
        return Err(Error::file(path, fault));
    }
    let mut folders = path.ancestors().skip(1);
    match folders.find_map(|folder| fs::metadata(folder).ok()) {
        Some(found) if !found.is_dir() => {
            Err(Error::file(path, "a file is where its folder would be"))
        }
        _ => Ok(()),
    }
}

/// The same where `-` is standard output: before [`Output::create_or_stdout`].
///
/// # Errors
/// As [`check`], but for standard output.
pub fn check_or_stdout(path: &Path) -> Result<(), Error> {
    if is_stdout(path) { Ok(()) } else { check(path) }
}

/// Whether `path` is none of `others`, which the same command reads or writes.
pub(crate) fn check_apart<'p>(
    path: &Path,
    others: impl IntoIterator<Item = &'p Path>,
) -> Result<(), Error> {
    let place = |path: &Path| {
        fs::canonicalize(path)
            .or_else(|_| std::path::absolute(path))
            .ok()
    };
    let own = place(path).filter(|_| !is_stdout(path));
    let is_own = |other: &Path| own.is_some() && place(other) == own;
    if others.into_iter().any(is_own) {
        let fault =
            "is another file of this command, which it reads or writes; name one of its own";
        return Err(Error::file(path, fault));
    }
    Ok(())
}

fn kind(of: FileType) -> &'static str {
    if of.is_dir() {
        return "a folder";
    }
    if of.is_symlink() {
        return "a symbolic link";
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        if of.is_fifo() {
            return "a pipe (FIFO)";
        }
        if of.is_socket() {
            return "a socket";
        }
    }
    "a device"
}

/// Writes `bytes` to `path`, completely or not at all.
///
/// # Errors
/// As [`Output::create`] and [`Output::finish`].
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
}
