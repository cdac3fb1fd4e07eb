//! Files that what a module tells is kept in while one listens: a table of its records
//! (`.csv`), or all of it for other programs (`.mcap`).

mod messages;

use std::path::{Path, PathBuf};

use firmware::Packet;
use host_sim::Error;
use host_sim::origin::Origin;
use host_sim::output::{self, Output, is_stdout};

use crate::table::RecordWriter;
use messages::Messages;

pub(crate) struct RecordFile {
    path: PathBuf,
    form: Form,
}

enum Form {
    Table(Box<RecordWriter<Output>>),
    Messages(Box<Messages>),
}

fn is_messages(path: &Path) -> Result<bool, Error> {
    let ends_in = |ending| path.extension().is_some_and(|found| found == ending);
    if is_stdout(path) || ends_in("csv") {
        return Ok(false);
    }
    if ends_in("mcap") {
        return Ok(true);
    }
    let fault = "what is it to be? allowed: a name that ends in .csv (a table) or .mcap (messages)";
    Err(Error::file(path, fault))
}

/// Whether `path` can be written: before work that writes it.
pub(crate) fn check(path: &Path) -> Result<(), Error> {
    output::check_or_stdout(path)?;
    is_messages(path).map(drop)
}

/// The same, and there is no such file yet.
pub(crate) fn check_new(path: &Path) -> Result<(), Error> {
    check(path)?;
    if !is_stdout(path) && path.exists() {
        let fault = "is there already, and is not overwritten; name another file";
        return Err(Error::file(path, fault));
    }
    Ok(())
}

impl RecordFile {
    pub(crate) fn create(
        path: &Path,
        origin: &Origin,
        tick_hz: u32,
        classes: &[String],
    ) -> Result<Self, Error> {
        let failed = |error| Error::write(path, error);
        let form = if is_messages(path)? {
            let messages = Messages::new(Output::create(path)?, origin, tick_hz, classes);
            Form::Messages(Box::new(messages.map_err(failed)?))
        } else {
            let output = Output::create_or_stdout(path)?;
            let rows = RecordWriter::new(output, origin.clone(), tick_hz);
            Form::Table(Box::new(rows.map_err(failed)?))
        };
        Ok(Self {
            path: path.to_owned(),
            form,
        })
    }

    /// Writes records, answers and events; a table has records alone.
    pub(crate) fn packets(&mut self, packets: &[Packet]) -> Result<(), Error> {
        for packet in packets {
            let written = match (&mut self.form, packet) {
                (Form::Table(rows), Packet::Record(record)) => rows.row(record),
                (Form::Table(_), _) => Ok(()),
                (Form::Messages(messages), packet) => messages.packet(packet),
            };
            written.map_err(|error| Error::write(&self.path, error))?;
        }
        Ok(())
    }

    pub(crate) fn line(&mut self, line: &str) -> Result<(), Error> {
        let written = match &mut self.form {
            Form::Table(_) => Ok(()),
            Form::Messages(messages) => messages.line(line),
        };
        written.map_err(|error| Error::write(&self.path, error))
    }

    pub(crate) fn finish(self) -> Result<(), Error> {
        let output = match self.form {
            Form::Table(rows) => rows.finish(),
            Form::Messages(messages) => messages.finish(),
        };
        output
            .map_err(|error| Error::write(&self.path, error))?
            .finish()
    }
}
