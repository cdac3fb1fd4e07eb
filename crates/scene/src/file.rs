//! Files that others wrote, read whole: only regular ones, and only up to a size.
//!
//! A device never ends, and a pipe that no one writes to is waited for without end. What is too
//! large is refused before it fills the memory.

use std::fs::{File, Metadata};
use std::io::{self, ErrorKind, Read as _};
use std::path::Path;

/// Most bytes of a text that a person writes: a scene, a script. The longest scene here has 5 KiB.
pub const TEXT_BYTES: u64 = 1 << 20;

/// Most bytes of a recording or of records: six hours of 2,000 rows a second.
pub const TABLE_BYTES: u64 = 1 << 30;

/// Most bytes of a model, a program or a board's flash: a board has a hundredth of it.
pub const BINARY_BYTES: u64 = 1 << 26;

/// Reads a regular file of at most so many bytes.
///
/// # Errors
/// What keeps it from being read; [`ErrorKind::InvalidInput`] where it is no regular file, and
/// [`ErrorKind::FileTooLarge`] where it is larger.
pub fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    // Before it is opened, as this waits for whoever writes to a pipe.
    regular(&std::fs::metadata(path)?)?;
    up_to(File::open(path)?, most)
}

/// The same of a pipe that a shell has opened: `<(...)` or `/dev/stdin`.
///
/// # Errors
/// As [`read`].
pub fn read_piped(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    if !is_open_pipe(path) {
        return read(path, most);
    }
    up_to(File::open(path)?, most)
}

/// Reads a text in UTF-8 of at most [`TEXT_BYTES`].
///
/// # Errors
/// As [`read`]; [`ErrorKind::InvalidData`] names the line that is not UTF-8.
pub fn read_text(path: &Path) -> io::Result<String> {
    String::from_utf8(read(path, TEXT_BYTES)?).map_err(|error| {
        let valid = error.as_bytes().get(..error.utf8_error().valid_up_to());
        let line = valid
            .unwrap_or_default()
            .split(|byte| *byte == b'\n')
            .count();
        let fault = format!("line {line} is not UTF-8");
        io::Error::new(ErrorKind::InvalidData, fault)
    })
}

fn regular(found: &Metadata) -> io::Result<()> {
    let kind = match (found.is_file(), found.is_dir()) {
        (true, _) => return Ok(()),
        (_, true) => ErrorKind::IsADirectory,
        _ => ErrorKind::InvalidInput,
    };
    Err(io::Error::new(kind, "not a regular file"))
}

fn up_to(file: File, most: u64) -> io::Result<Vec<u8>> {
    let too_large = || {
        let fault = format!("larger than {} MiB", most >> 20);
        io::Error::new(ErrorKind::FileTooLarge, fault)
    };
    if file.metadata()?.len() > most {
        return Err(too_large());
    }
    let mut bytes = Vec::new();
    file.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        return Err(too_large());
    }
    Ok(bytes)
}

#[cfg(unix)]
fn is_open_pipe(path: &Path) -> bool {
    use std::os::unix::fs::FileTypeExt as _;

    let is_open = path.starts_with("/dev/fd") || path == Path::new("/dev/stdin");
    is_open && std::fs::metadata(path).is_ok_and(|found| found.file_type().is_fifo())
}

#[cfg(not(unix))]
fn is_open_pipe(_: &Path) -> bool {
    false
}

#[cfg(test)]
mod tests {
    use std::io::ErrorKind;
    use std::path::Path;

    use super::{TEXT_BYTES, read, read_text};

    #[test]
    fn what_is_too_large_is_refused_unread() {
        let file = tempfile::NamedTempFile::new().unwrap();
        file.as_file().set_len(TEXT_BYTES).unwrap();
        assert_eq!(read_text(file.path()).unwrap().len() as u64, TEXT_BYTES);
        file.as_file().set_len(1 << 40).unwrap();
        let fault = read_text(file.path()).unwrap_err();
        assert_eq!(fault.to_string(), "larger than 1 MiB");
        std::fs::write(file.path(), b"a\nb\xe4\n").unwrap();
        let fault = read_text(file.path()).unwrap_err();
        assert_eq!(fault.to_string(), "line 2 is not UTF-8");
    }

    #[cfg(unix)]
    #[test]
    fn only_regular_files_are_read() {
        let folder = tempfile::tempdir().unwrap();
        let fifo = folder.path().join("fifo");
        let made = std::process::Command::new("mkfifo").arg(&fifo).status();
        assert!(made.unwrap().success());
        for path in [folder.path(), Path::new("/dev/zero"), &fifo] {
            let fault = read(path, TEXT_BYTES).unwrap_err();
            assert_eq!(
                fault.to_string(),
                "not a regular file",
                "{}",
                path.display()
            );
        }
        let none = read(&folder.path().join("none"), TEXT_BYTES).unwrap_err();
        assert_eq!(none.kind(), ErrorKind::NotFound);
    }
}
