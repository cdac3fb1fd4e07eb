//! What has come over the serial line, taken apart.

use host_sim::Error;
use wire::{LINE_BYTES, Packet, Piece, Splitter, TickRecord};

/// A line or a packet.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Heard {
    Line(String),
    Packet(Packet),
}

/// Whoever reads the line.
#[derive(Debug, Default)]
pub(crate) struct Ear {
    splitter: Splitter<LINE_BYTES>,
}

impl Ear {
    /// Takes bytes; the board must say nothing that cannot be read.
    pub(crate) fn hear(&mut self, bytes: &[u8]) -> Result<Vec<Heard>, Error> {
        let mut heard = Vec::new();
        for byte in bytes {
            let garbled = |what: String| Error::Work(format!("the board has sent {what}"));
            heard.extend(match self.splitter.push(*byte) {
                None => None,
                Some(Piece::Line(line)) => {
                    let line = String::from_utf8(line.to_vec());
                    Some(Heard::Line(
                        line.map_err(|error| garbled(error.to_string()))?,
                    ))
                }
                Some(Piece::Frame(frame)) => {
                    let packet = frame.try_into().map(Packet::from_bytes);
                    let packet = packet.map_err(|_| garbled(format!("{frame:?}")))?;
                    Some(Heard::Packet(packet))
                }
                Some(Piece::Garbled(what)) => return Err(garbled(format!("{what:?}"))),
            });
        }
        Ok(heard)
    }
}

/// The records of what was heard.
pub(crate) fn records(heard: &[Heard]) -> Vec<TickRecord> {
    let records = heard.iter().filter_map(|heard| match heard {
        Heard::Packet(Packet::Record(record)) => Some(*record),
        _ => None,
    });
    records.collect()
}

/// The lines that begin with no time: replies.
pub(crate) fn replies(heard: &[Heard]) -> Vec<String> {
    let lines = heard.iter().filter_map(|heard| match heard {
        Heard::Line(line) => Some(line.clone()),
        Heard::Packet(_) => None,
    });
    lines
        .filter(|line| !line.starts_with(|first: char| first.is_ascii_digit()))
        .collect()
}
