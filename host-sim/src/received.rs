//! What comes from a module, taken apart: packets, and lines of text between them.

use firmware::Packet;
use tactile::name::is_hidden;
use wire::{LINE_BYTES, Piece, Splitter};

/// What has come.
#[derive(Debug, Clone, PartialEq)]
pub enum Received {
    /// A line, without its end.
    Line(String),
    /// A packet.
    Packet(Packet),
    /// What is neither: a piece that was under way as reading began, a damaged one, or one of
    /// another version.
    Garbled,
}

impl Received {
    /// It, if it is a packet.
    pub fn packet(self) -> Option<Packet> {
        match self {
            Self::Packet(packet) => Some(packet),
            Self::Line(_) | Self::Garbled => None,
        }
    }
}

/// Reads what a module sends, by a probe or a serial line.
#[derive(Debug, Default)]
pub struct Receiver {
    splitter: Splitter<LINE_BYTES>,
}

impl Receiver {
    /// What `bytes` complete.
    pub fn take(&mut self, bytes: &[u8]) -> Vec<Received> {
        let mut received = Vec::new();
        for byte in bytes {
            received.extend(self.splitter.push(*byte).map(|piece| match piece {
                Piece::Line(line) => Received::Line(
                    // It goes to terminals and into files.
                    String::from_utf8_lossy(line).replace(is_hidden, "\u{fffd}"),
                ),
                Piece::Frame(frame) => {
                    wire::open(frame).map_or(Received::Garbled, Received::Packet)
                }
                Piece::Garbled(_) => Received::Garbled,
            }));
        }
        received
    }

    /// The packets that `bytes` complete.
    pub fn packets(&mut self, bytes: &[u8]) -> Vec<Packet> {
        let received = self.take(bytes).into_iter();
        received.filter_map(Received::packet).collect()
    }
}

#[cfg(test)]
mod tests {
    use firmware::{Event, EventRecord, Packet, Place};
    use wire::TickRecord;

    use super::{Received, Receiver};

    #[test]
    fn packets_and_lines_come_in_any_order_and_what_is_damaged_is_left_out() {
        let (sequence, none) = (7, TickRecord::default());
        let record = Packet::Record(TickRecord { sequence, ..none });
        let (place, number) = (Place::new(1, 0), 3);
        let event = Event::Touch { place, number };
        let touch = Packet::Event(EventRecord { sequence, event });
        let mut damaged = wire::frame(&record);
        damaged[5] ^= 4;
        let bytes = [
            b"0.003 touch right 3\r\n",
            &wire::frame(&record)[..],
            &damaged,
            &wire::frame(&touch),
            b"ok \x1b[2Jstop\r\n",
        ];
        // Whatever comes in one go.
        let mut receiver = Receiver::default();
        let mut received = Vec::new();
        for chunk in bytes.concat().chunks(3) {
            received.extend(receiver.take(chunk));
        }
        let expected = [
            Received::Line("0.003 touch right 3".into()),
            Received::Packet(record),
            Received::Garbled,
            Received::Packet(touch),
            Received::Line("ok \u{fffd}[2Jstop".into()),
        ];
        assert_eq!(received, expected);
        let packets = Receiver::default().packets(&bytes.concat());
        assert_eq!(packets, [record, touch]);
    }
}
