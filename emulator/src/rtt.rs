//! What a probe reads from RAM and writes into it: RTT's rings, of which the first is the
//! log, decoded by defmt.

use std::fmt::Write as _;

use defmt_decoder::{DecodeError, Table};

use crate::chip::Fault;
use crate::memory::Memories;
use crate::program::Program;

/// Offsets in the control block: how many rings go up, and the first ring.
const UPS: u32 = 16;
const RINGS: u32 = 24;
/// Bytes of a ring's description.
const RING: u32 = 24;

/// Offsets in it: the buffer, its length, the offsets of writer and reader, and what is done
/// where there is no room.
const BUFFER: u32 = 4;
const LENGTH: u32 = 8;
const WRITER: u32 = 12;
const READER: u32 = 16;
const MODE: u32 = 20;

/// The mode of a channel whose writer waits for room, which a probe sets as it attaches.
const BLOCK_IF_FULL: u32 = 2;

/// The control block in RAM, as a probe finds it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rtt {
    block: u32,
}

impl Rtt {
    pub(crate) fn new(program: &Program) -> Result<Self, Fault> {
        let block = program.symbol("_SEGGER_RTT")?;
        Ok(Self { block })
    }

    /// The ring of the log.
    pub(crate) const fn log(self) -> Ring {
        Ring {
            at: self.block + RINGS,
        }
    }

    /// That of packets, if the program has one.
    pub(crate) fn packets(self, ram: &Memories) -> Result<Option<Ring>, Fault> {
        let ups = ram.word(self.block + UPS)?;
        let at = self.block + RINGS + RING;
        Ok((ups > 1).then_some(Ring { at }))
    }

    /// That of requests, if the program has one.
    pub(crate) fn requests(self, ram: &Memories) -> Result<Option<Ring>, Fault> {
        let [ups, downs] = [ram.word(self.block + UPS)?, ram.word(self.block + UPS + 4)?];
        let at = self.block + RINGS + RING * ups.min(3);
        Ok((downs > 0).then_some(Ring { at }))
    }
}

/// A ring in RAM.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ring {
    at: u32,
}

impl Ring {
    /// Where the writer stands; changes with every line.
    pub(crate) fn writer(self, ram: &Memories) -> Result<u32, Fault> {
        ram.word(self.at + WRITER)
    }

    /// Asks the program to wait where the ring is full, as probe-rs does.
    pub(crate) fn ask_to_wait(self, ram: &Memories) -> Result<(), Fault> {
        ram.write(self.at + MODE, &BLOCK_IF_FULL.to_le_bytes())
    }

    /// Leaves no room, as if nobody had fetched anything for long.
    pub(crate) fn fill(self, ram: &Memories) -> Result<(), Fault> {
        let length = ram.word(self.at + LENGTH)?;
        let reader = (self.writer(ram)? + 1).checked_rem(length).unwrap_or(0);
        ram.write(self.at + READER, &reader.to_le_bytes())
    }

    /// Fetches what has been written.
    pub(crate) fn drain(self, ram: &Memories) -> Result<Vec<u8>, Fault> {
        let field = |offset| ram.word(self.at + offset);
        let (buffer, length) = (field(BUFFER)?, field(LENGTH)?);
        let (writer, mut reader) = (field(WRITER)?, field(READER)?);
        let mut bytes = Vec::new();
        // Before the program has set it up the block is zero.
        if length == 0 || writer >= length || reader >= length {
            return Ok(bytes);
        }
        while reader != writer {
            let end = if writer > reader { writer } else { length };
            let start = bytes.len();
            bytes.resize(start + (end - reader) as usize, 0);
            ram.read(buffer + reader, &mut bytes[start..])?;
            reader = if end == length { 0 } else { end };
        }
        ram.write(self.at + READER, &reader.to_le_bytes())?;
        Ok(bytes)
    }

    /// Writes what a PC sends, as far as there is room; how many bytes there was room for.
    pub(crate) fn send(self, ram: &Memories, bytes: &[u8]) -> Result<usize, Fault> {
        let field = |offset| ram.word(self.at + offset);
        let (buffer, length) = (field(BUFFER)?, field(LENGTH)?);
        let (mut writer, reader) = (field(WRITER)?, field(READER)?);
        if length == 0 || writer >= length || reader >= length {
            return Ok(0);
        }
        let mut sent = 0;
        for byte in bytes {
            let next = if writer + 1 < length { writer + 1 } else { 0 };
            if next == reader {
                break;
            }
            ram.write(buffer + writer, &[*byte])?;
            writer = next;
            sent += 1;
        }
        ram.write(self.at + WRITER, &writer.to_le_bytes())?;
        Ok(sent)
    }
}

/// Turns the bytes of the log into lines.
#[derive(Debug)]
pub(crate) struct LogDecoder {
    table: Table,
    encoded: Vec<u8>,
}

impl LogDecoder {
    /// The decoder for a program's log.
    pub(crate) fn new(program: &Program) -> Result<Self, Fault> {
        let bad = |fault: String| Fault::Program(format!("defmt: {fault}"));
        let table = Table::parse(program.bytes())
            .map_err(|error| bad(error.to_string()))?
            .ok_or_else(|| bad("the program does not log".to_owned()))?;
        Ok(Self {
            table,
            encoded: Vec::new(),
        })
    }

    /// Takes bytes of the log and returns the lines that are whole by now.
    pub(crate) fn lines(&mut self, bytes: &[u8]) -> Vec<String> {
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
