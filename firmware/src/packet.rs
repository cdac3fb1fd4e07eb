//! What a module sends: packets, each in a frame of its own.

use serde::{Deserialize, Serialize};
use wire::{Answer, TickRecord};

use crate::Event;

/// What a module sends.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Packet {
    /// One whisker in one tick.
    Record(TickRecord),
    /// What became of a request.
    Answer(Answer),
    /// What has happened.
    Event(EventRecord),
}

/// An event and its tick.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct EventRecord {
    /// Ticks since the module started, as in a record.
    pub sequence: u32,
    /// What happened in it.
    pub event: Event,
}

#[cfg(test)]
mod tests {
    use mlx90333::{Faults, FrameError};
    use tactile::Decision;
    use whisking::motor;
    use wire::{Answer, CommandStatus, FRAME_BYTES, Piece, Splitter, TickRecord};

    use super::{EventRecord, Packet};
    use crate::{Event, Health, Place, SensorFault};

    /// What a PC makes of a packet's frame.
    fn received(packet: &Packet) -> Option<Packet> {
        let mut splitter = Splitter::<FRAME_BYTES>::new();
        wire::frame(packet)
            .iter()
            .find_map(|byte| match splitter.push(*byte)? {
                Piece::Frame(content) => wire::open(content),
                piece => panic!("{piece:?}"),
            })
    }

    #[test]
    fn the_longest_of_each_kind_has_room() {
        let place = Place::new(u8::MAX, u8::MAX);
        let sum = FrameError::BadSum {
            expected: u8::MAX,
            found: u8::MAX,
        };
        let decision = Decision::from_memory(u32::MAX, u32::MAX, u32::MAX).unwrap();
        let health = Health {
            worst_tenths: u16::MAX,
            missed: u32::MAX,
            dropped: u32::MAX,
        };
        let events = [
            Event::Touch {
                place,
                number: u16::MAX,
            },
            Event::Decision(place, decision),
            Event::SensorLost(place, SensorFault::Frame(sum)),
            Event::SensorLost(
                place,
                SensorFault::Frame(FrameError::Sensor(Faults::new(u16::MAX))),
            ),
            Event::ZeroMoved(place, [i16::MIN; 2]),
            Event::MotorFault(place, motor::Fault::InvalidHall(u8::MAX)),
            Event::Health(health),
            Event::Limit(u8::MAX),
        ];
        let sequence = u32::MAX;
        let events = events.map(|event| Packet::Event(EventRecord { sequence, event }));
        let answer = Packet::Answer(Answer {
            sequence,
            tag: u16::MAX,
            command: u8::MAX,
            status: CommandStatus::Other(u8::MAX),
            values: [i32::MIN; 2],
        });
        let record = Packet::Record(TickRecord {
            sequence,
            duty: i16::MIN,
            ..TickRecord::default()
        });
        for packet in events.into_iter().chain([answer, record]) {
            assert_eq!(received(&packet), Some(packet));
        }
        assert_eq!(wire::frame(&record).len(), wire::RECORD_FRAME_BYTES);
    }
}
