//! The log: from bytes to lines.

use std::fmt::Write as _;

use defmt_decoder::{DecodeError, Table};

use crate::program::BadProgram;

/// Turns the bytes of the log into lines.
#[derive(Debug)]
pub struct LogDecoder {
    table: Table,
    encoded: Vec<u8>,
}

impl LogDecoder {
    /// The decoder for the log of the program in the ELF file `elf`.
    ///
    /// # Errors
    /// [`BadProgram`] if it does not log by defmt.
    pub fn new(elf: &[u8]) -> Result<Self, BadProgram> {
        let bad = |fault: String| BadProgram(format!("defmt: {fault}"));
        let table = Table::parse(elf)
            .map_err(|error| bad(error.to_string()))?
            .ok_or_else(|| bad("the program does not log".to_owned()))?;
        Ok(Self {
            table,
            encoded: Vec::new(),
        })
    }

    /// Takes bytes of the log and returns the lines that are whole by now.
    pub fn lines(&mut self, bytes: &[u8]) -> Vec<String> {
        if bytes.is_empty() {
            return Vec::new();
        }
        self.encoded.extend_from_slice(bytes);
        // Frames end with a zero; what follows the last is not yet whole.
        let whole = self
            .encoded
            .iter()
            .rposition(|&byte| byte == 0)
            .map_or(0, |end| end + 1);
        let rest = self.encoded.split_off(whole);
        let frames = std::mem::replace(&mut self.encoded, rest);
        let mut decoder = self.table.new_stream_decoder();
        decoder.received(&frames);
        let mut lines = Vec::new();
        loop {
            match decoder.decode() {
                Ok(frame) => {
                    let mut line = String::new();
                    if let Some(time) = frame.display_timestamp() {
                        // Writing to a string does not fail.
                        let _ = write!(line, "{time} ");
                    }
                    if let Some(level) = frame.level() {
                        let _ = write!(line, "{:5} ", level.as_str().to_uppercase());
                    }
                    let _ = write!(line, "{}", frame.display_message());
                    lines.push(line);
                }
                Err(DecodeError::UnexpectedEof) => return lines,
                Err(DecodeError::Malformed) => lines.push("(a broken line)".to_owned()),
            }
        }
    }
}
