//! The project's files by their paths.

use std::io;
use std::path::{Path, PathBuf};

use scene::file;
use tactile::ModelBuf;

use crate::Error;
use crate::decisions::{self, Columns, Decided};
use crate::loaded::model_of;
use crate::origin::{Origin, TICK_HZ};
use crate::output::Output;
use crate::rate::{Said, USUAL_HZ};
use crate::recording::{self, Recording, Stream};

/// Reads a recording whose channels are the columns `channels`.
///
/// # Errors
/// [`Error::Input`] names the file, the line and what is wrong with it.
pub fn read_recording(path: &Path, channels: [&str; 2]) -> Result<Vec<Stream>, Error> {
    whole_recording(path, channels).map(|recording| recording.streams)
}

/// The same with what stands above its table.
pub(crate) fn whole_recording(path: &Path, channels: [&str; 2]) -> Result<Recording, Error> {
    let bytes = file::read_piped(path, file::TABLE_BYTES);
    let bytes = bytes.map_err(|error| Error::file(path, error))?;
    recording::read_whole(bytes.as_slice(), channels).map_err(|fault| Error::file(path, fault))
}

/// What stands above the table in a file of the samples a second.
pub(crate) fn rate_of(path: &Path, recording: &Recording) -> Said {
    let who = format!("{}: {TICK_HZ}", path.display());
    (who, recording.tick_hz)
}

/// Writes a recording of so many samples a second, which stand above it where they are not the
/// usual ones, and finishes.
///
/// # Errors
/// As [`Output::finish`].
pub fn write_recording(output: Output, streams: &[Stream], tick_hz: u32) -> Result<(), Error> {
    let mut origin = Origin::default();
    if tick_hz != USUAL_HZ {
        origin = origin.with(TICK_HZ, tick_hz);
    }
    write(output, |output| {
        recording::write_from(output, &origin, streams)
    })
}

pub(crate) fn write_decisions(
    output: Output,
    decisions: &[Decided],
    columns: Columns,
) -> Result<(), Error> {
    write(output, |output| {
        decisions::write(output, decisions, columns)
    })
}

pub(crate) fn write(
    mut output: Output,
    fill: impl FnOnce(&mut Output) -> io::Result<()>,
) -> Result<(), Error> {
    fill(&mut output).map_err(|source| output.failed(source))?;
    output.finish()
}

/// Reads and checks a model file.
///
/// # Errors
/// [`Error::Input`] names the file and why it is refused.
pub fn load_model(path: &Path) -> Result<(PathBuf, ModelBuf), Error> {
    let bytes = file::read(path, file::BINARY_BYTES).map_err(|error| Error::file(path, error))?;
    model_of(path, &bytes)
}
