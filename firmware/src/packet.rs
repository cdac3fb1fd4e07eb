//! What a module sends: packets, each in a frame of its own.
//!
//! Each is a byte that says what it is, and 20 bytes; numbers are little-endian. A tick's time and
//! a frame's length are the same whatever the numbers are, and nothing can fail on a board.

use mlx90333::{Faults, FrameError};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use tactile::{Decision, Pose};
use whisking::motor;
use wire::{Answer, TickRecord};

use crate::faults::number;
use crate::lines::halves;
use crate::{Event, Health, NodeEvent, Part, Place, SensorFault};

/// What a module sends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Packet {
    /// One whisker in one tick.
    Record(TickRecord),
    /// What became of a request.
    Answer(Answer),
    /// What has happened.
    Event(EventRecord),
}

/// An event and its tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EventRecord {
    /// Ticks since the module started, as in a record.
    pub sequence: u32,
    /// What happened in it.
    pub event: Event,
}

const RECORD: u8 = 0;
const ANSWER: u8 = 1;
const EVENT: u8 = 2;

pub(crate) const PACKET_BYTES: usize = 21;

type Words = [u32; 5];
type Bytes = [[u8; 4]; 5];

impl Packet {
    /// As it is sent.
    pub fn bytes(&self) -> [u8; PACKET_BYTES] {
        let (kind, words) = match self {
            Self::Record(record) => (RECORD, record.words()),
            Self::Answer(answer) => (ANSWER, answer.words()),
            Self::Event(event) => (EVENT, event.words()),
        };
        let mut bytes = [kind; PACKET_BYTES];
        let [_, rest @ ..] = &mut bytes;
        for (place, byte) in rest
            .iter_mut()
            .zip(words.map(u32::to_le_bytes).as_flattened())
        {
            *place = *byte;
        }
        bytes
    }

    /// The answer that these bytes are, if they are one.
    pub(crate) fn answer([kind, rest @ ..]: &[u8; PACKET_BYTES]) -> Option<Answer> {
        let mut words = [0; 5];
        for (word, bytes) in words.iter_mut().zip(rest.as_chunks().0) {
            *word = u32::from_le_bytes(*bytes);
        }
        (*kind == ANSWER).then(|| Answer::from_words(words))
    }
}

impl Serialize for Packet {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.bytes().serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Packet {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let (kind, bytes) = <(u8, Bytes)>::deserialize(deserializer)?;
        let words = bytes.map(u32::from_le_bytes);
        let packet = match kind {
            RECORD => Some(Self::Record(TickRecord::from_words(words))),
            ANSWER => Some(Self::Answer(Answer::from_words(words))),
            EVENT => EventRecord::from_words(words).map(Self::Event),
            _ => None,
        };
        packet.ok_or_else(|| D::Error::custom("a packet of another version"))
    }
}

mod kind {
    pub(super) const TOUCH: u8 = 0;
    pub(super) const TOUCH_END: u8 = 1;
    pub(super) const DECISION: u8 = 2;
    pub(super) const SENSOR_LOST: u8 = 3;
    pub(super) const SENSOR_BACK: u8 = 4;
    pub(super) const ZERO_MOVED: u8 = 5;
    pub(super) const MOTOR_FAULT: u8 = 6;
    pub(super) const MOTOR_RETRY: u8 = 7;
    pub(super) const MOTOR_GIVEN_UP: u8 = 8;
    pub(super) const ARMED: u8 = 9;
    pub(super) const HEALTH: u8 = 10;
    pub(super) const LIMIT: u8 = 11;
    pub(super) const STOPPED: u8 = 12;
    pub(super) const FRAME: u8 = 13;
    pub(super) const POSE: u8 = 14;
    pub(super) const NODE: u8 = 15;
}

impl EventRecord {
    /// As it is sent: the tick; what, side, whisker and a number of 8 bits; three values.
    fn words(&self) -> Words {
        const NONE: [u32; 3] = [0; 3];
        let nowhere = Place::new(0, 0);
        let (kind, place, number, values) = match self.event {
            Event::Touch { place, number } => (kind::TOUCH, place, 0, [number.into(), 0, 0]),
            Event::TouchEnd { place, number } => (kind::TOUCH_END, place, 0, [number.into(), 0, 0]),
            Event::Decision(place, decision) if Part::Classifier.is_built() => {
                (kind::DECISION, place, 0, decision.words())
            }
            Event::Pose(place, pose) if Part::Pose.is_built() => {
                let [tilt, depth] = pose.words();
                (kind::POSE, place, 0, [tilt, depth, 0])
            }
            Event::SensorLost(place, fault) => {
                (kind::SENSOR_LOST, place, fault.code(), details(fault))
            }
            Event::Frame(place, bytes) => {
                let [high, low] = halves(bytes);
                (kind::FRAME, place, 0, [high, low, 0])
            }
            Event::SensorBack(place) => (kind::SENSOR_BACK, place, 0, NONE),
            Event::ZeroMoved(place, codes) => {
                let [x, y] = codes.map(|code| u32::from(code.cast_unsigned()));
                (kind::ZERO_MOVED, place, 0, [x, y, 0])
            }
            Event::MotorFault(place, fault) if Part::Motion.is_built() => {
                let hall = match fault {
                    motor::Fault::InvalidHall(hall) => hall,
                    _ => 0,
                };
                (kind::MOTOR_FAULT, place, fault.code(), [hall.into(), 0, 0])
            }
            Event::MotorRetry(place) => (kind::MOTOR_RETRY, place, 0, NONE),
            Event::MotorGivenUp(place) => (kind::MOTOR_GIVEN_UP, place, 0, NONE),
            Event::Node(node, what) if Part::Bus.is_built() => {
                let [number, other] = what.code();
                (
                    kind::NODE,
                    Place::new(0, node),
                    number,
                    [other.into(), 0, 0],
                )
            }
            Event::Armed => (kind::ARMED, nowhere, 0, NONE),
            Event::Stopped => (kind::STOPPED, nowhere, 0, NONE),
            Event::Health(health) => {
                let worst = health.worst_tenths.into();
                let values = [worst, health.missed, health.dropped];
                (kind::HEALTH, nowhere, 0, values)
            }
            Event::Limit(number) => (kind::LIMIT, nowhere, number, NONE),
            Event::Decision(..) | Event::Pose(..) | Event::MotorFault(..) | Event::Node(..) => {
                (u8::MAX, nowhere, 0, NONE)
            }
        };
        let what = u32::from_le_bytes([kind, place.side, place.whisker, number]);
        let [a, b, c] = values;
        [self.sequence, what, a, b, c]
    }

    /// As it was sent; `None`: one of a later version.
    fn from_words([sequence, what, a, b, c]: Words) -> Option<Self> {
        let [kind, side, whisker, number] = what.to_le_bytes();
        let place = Place::new(side, whisker);
        let event = match kind {
            kind::TOUCH => Event::Touch {
                place,
                number: a as u16,
            },
            kind::TOUCH_END => Event::TouchEnd {
                place,
                number: a as u16,
            },
            kind::DECISION => Event::Decision(place, Decision::from_memory(a, b, c)?),
            kind::POSE => Event::Pose(place, Pose::from_words([a, b])),
            kind::SENSOR_LOST => Event::SensorLost(place, sensor_fault(number, [a, b])?),
            kind::FRAME => {
                let bytes = u64::from(a) << 32 | u64::from(b);
                Event::Frame(place, bytes.to_be_bytes())
            }
            kind::SENSOR_BACK => Event::SensorBack(place),
            kind::ZERO_MOVED => Event::ZeroMoved(place, [a, b].map(|code| code as i16)),
            kind::MOTOR_FAULT => {
                let fault = match motor::Fault::from_code(number)? {
                    motor::Fault::InvalidHall(_) => motor::Fault::InvalidHall(a as u8),
                    fault => fault,
                };
                Event::MotorFault(place, fault)
            }
            kind::MOTOR_RETRY => Event::MotorRetry(place),
            kind::MOTOR_GIVEN_UP => Event::MotorGivenUp(place),
            kind::NODE => Event::Node(whisker, NodeEvent::of([number, a as u8])?),
            kind::ARMED => Event::Armed,
            kind::STOPPED => Event::Stopped,
            kind::HEALTH => Event::Health(Health {
                worst_tenths: a as u16,
                missed: b,
                dropped: c,
            }),
            kind::LIMIT => Event::Limit(number),
            _ => return None,
        };
        Some(Self { sequence, event })
    }
}

/// What is known of a sensor's fault besides its number.
fn details(fault: SensorFault) -> [u32; 3] {
    #[cfg(feature = "tmag5170")]
    if let SensorFault::Tilt(fault) = fault {
        let [a, b] = fault.values();
        return [a, b, 0];
    }
    [detail(fault).into(), 0, 0]
}

fn detail(fault: SensorFault) -> u16 {
    match fault {
        SensorFault::Frame(FrameError::BadStart(found)) => found.into(),
        SensorFault::Frame(FrameError::BadSum { expected, found }) => {
            u16::from_le_bytes([expected, found])
        }
        SensorFault::Frame(FrameError::Sensor(faults)) => faults.bits(),
        SensorFault::Often(last) => last.into(),
        _ => 0,
    }
}

fn sensor_fault(number: u8, details: [u32; 2]) -> Option<SensorFault> {
    #[cfg(feature = "tmag5170")]
    if let Some(fault) = crate::TiltFault::of(number, details) {
        return Some(SensorFault::Tilt(fault));
    }
    let [detail, _] = details.map(|detail| detail as u16);
    let [low, high] = detail.to_le_bytes();
    let frame = match number {
        number::NO_FRAME => return Some(SensorFault::NoFrame),
        number::BUS => return Some(SensorFault::Bus),
        number::FROZEN => return Some(SensorFault::Frozen),
        number::JUMP => return Some(SensorFault::Jump),
        number::OFTEN => return Some(SensorFault::Often(low)),
        number::NO_SENSOR => FrameError::NoSensor,
        number::LINE_LOW => FrameError::LineLow,
        number::BAD_START => FrameError::BadStart(low),
        number::BAD_SUM => FrameError::BadSum {
            expected: low,
            found: high,
        },
        number::SENSOR_REPORT => FrameError::Sensor(Faults::new(detail)),
        number::STUCK_WORDS => FrameError::StuckWords,
        _ => return None,
    };
    Some(SensorFault::Frame(frame))
}

#[cfg(test)]
mod tests {
    use mlx90333::{Faults, FrameError};
    use proptest::prelude::*;
    use tactile::{Decision, Pose};
    use whisking::motor;
    use wire::{
        Answer, Command, CommandStatus, FRAME_BYTES, Piece, Splitter, TaggedCommand, TickRecord,
        WhiskerId,
    };

    use super::{EventRecord, Packet};
    use crate::{Event, Health, NodeEvent, Part, Place, SensorFault};

    fn received(packet: &Packet) -> Option<Packet> {
        let mut splitter = Splitter::<FRAME_BYTES>::new();
        wire::frame(packet)
            .iter()
            .find_map(|byte| match splitter.push(*byte)? {
                Piece::Frame(content) => wire::open(content),
                piece => panic!("{piece:?}"),
            })
    }

    fn sensor_faults() -> Vec<SensorFault> {
        use SensorFault::{Bus, Frozen, Jump, NoFrame, Often};
        let [expected, found] = [0xFE, 12];
        let frames = [
            FrameError::NoSensor,
            FrameError::LineLow,
            FrameError::BadStart(found),
            FrameError::BadSum { expected, found },
            FrameError::Sensor(Faults::new(0x8EFE)),
            FrameError::StuckWords,
        ];
        let mut faults = frames.map(SensorFault::Frame).to_vec();
        faults.extend([NoFrame, Bus, Frozen, Jump, Often(18)]);
        #[cfg(feature = "tmag5170")]
        faults.extend(tilt_faults().into_iter().map(SensorFault::Tilt));
        faults
    }

    #[cfg(feature = "tmag5170")]
    fn tilt_faults() -> Vec<crate::TiltFault> {
        use crate::TiltFault::{NoMagnet, NotWritten, Reply, Reported};
        use tmag5170::ReplyError::{self, LineLow, NoSensor, Rejected, Restarted};
        use tmag5170::{Register, Status, StatusFaults};

        let [expected, found] = [3, 12];
        let bad_crc = ReplyError::BadCrc { expected, found };
        let sensor = ReplyError::Sensor(Status::new(0x308));
        let of_lines = [NoSensor, LineLow, Rejected, bad_crc];
        let mut faults = vec![Reported(StatusFaults::NONE), NoMagnet];
        faults.extend(of_lines.map(Reply));
        faults.extend([Restarted, sensor].map(Reply));
        faults.extend(StatusFaults::KNOWN.map(|known| Reported(known.bit)));
        faults.extend(Register::ALL.map(NotWritten));
        faults
    }

    /// One of each kind, with bytes that differ.
    fn events() -> Vec<Event> {
        let (place, number) = (Place::new(1, 3), 0xFEDC);
        let mut events = vec![
            Event::Touch { place, number },
            Event::TouchEnd { place, number },
            Event::Pose(place, Pose::from_words([0x8123_4567, 0x89AB_CDEF])),
            Event::Frame(place, 0x8123_4567_89AB_CDEF_u64.to_be_bytes()),
            Event::SensorBack(place),
            Event::ZeroMoved(place, [i16::MIN, 0x0123]),
            Event::MotorRetry(place),
            Event::MotorGivenUp(place),
            Event::Armed,
            Event::Stopped,
            Event::Health(Health {
                worst_tenths: number,
                missed: 0x8123_4567,
                dropped: 0x89AB_CDEF,
            }),
            Event::Limit(0xFE),
        ];
        let decisions = [[1, 0, 0], [0x8123_4567, 0x89AB_CDEF, u32::MAX]];
        let decisions = decisions.map(|[a, b, c]| Decision::from_memory(a, b, c).unwrap());
        events.extend(decisions.map(|decision| Event::Decision(place, decision)));
        let lost = |fault| Event::SensorLost(place, fault);
        events.extend(sensor_faults().into_iter().map(lost));
        let motors = (1..16).filter_map(motor::Fault::from_code);
        let motors = motors.chain([motor::Fault::InvalidHall(5)]);
        events.extend(motors.map(|fault| Event::MotorFault(place, fault)));
        let [joined, left, twin] = [NodeEvent::Joined, NodeEvent::Left, NodeEvent::Twin];
        let nodes = [
            joined,
            left,
            twin,
            NodeEvent::Heard(29),
            NodeEvent::Lost(30),
        ];
        if Part::Bus.is_built() {
            events.extend(nodes.map(|what| Event::Node(31, what)));
        }
        events
    }

    #[test]
    fn packets_come_as_they_were_sent() {
        let sequence = 0x8123_4567;
        let events = events().into_iter();
        let events = events.map(|event| Packet::Event(EventRecord { sequence, event }));
        let answers = (0..=u8::MAX).map(|code| {
            Packet::Answer(Answer {
                sequence,
                tag: 0xFEDC,
                command: !code,
                status: CommandStatus::from_code(code),
                values: [i32::MIN, 0x0123_4567],
            })
        });
        for packet in events.chain(answers) {
            assert_eq!(received(&packet), Some(packet));
        }
    }

    proptest! {
        #[test]
        fn any_bytes_are_a_packet_or_none(kind: u8, bytes: [u8; 20]) {
            let content = wire::frame(&(kind, bytes));
            let mut splitter = Splitter::<FRAME_BYTES>::new();
            for byte in &content {
                if let Some(Piece::Frame(content)) = splitter.push(*byte) {
                    let packet: Option<Packet> = wire::open(content);
                    prop_assert!(packet.is_none() || kind < 3);
                }
            }
        }
    }

    /// By a Python program that follows docs/protocol.md, with zlib's sum and a COBS of its own.
    #[test]
    fn frames_are_those_of_another_program() {
        let sequence = 0x0403_0201;
        let (place, number) = (Place::new(1, 3), 0x0102);
        let event = Event::Touch { place, number };
        let framed = wire::frame(&Packet::Event(EventRecord { sequence, event }));
        let expected = [
            0x00, 0x06, 0x02, 0x01, 0x02, 0x03, 0x04, 0x03, 0x01, 0x03, 0x03, 0x02, 0x01, 0x01,
            0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x05, 0x80, 0xBC, 0xB2, 0xC5, 0x00,
        ];
        assert_eq!(framed[..], expected);
        let answer = Packet::Answer(Answer {
            sequence,
            tag: 7,
            command: 8,
            status: CommandStatus::OutOfRange,
            values: [-2, 5],
        });
        let expected = [
            0x00, 0x07, 0x01, 0x01, 0x02, 0x03, 0x04, 0x07, 0x08, 0x08, 0x03, 0xFE, 0xFF, 0xFF,
            0xFF, 0x05, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x05, 0x19, 0x70, 0x86, 0x72, 0x00,
        ];
        assert_eq!(wire::frame(&answer)[..], expected);
        // 700 and -2 are varints, the latter in zigzag.
        let command = Command::Gain(WhiskerId { side: 1, number: 2 }, -2);
        let framed = wire::frame(&TaggedCommand { tag: 700, command });
        let expected = [
            0x00, 0x0B, 0xBC, 0x05, 0x08, 0x01, 0x02, 0x03, 0x3D, 0x8C, 0x63, 0x7B, 0x00,
        ];
        assert_eq!(framed[..], expected);
    }

    #[test]
    fn a_record_lies_where_the_page_says() {
        let record = TickRecord {
            sequence: 0x0403_0201,
            duty: 0x0E0D,
            ..TickRecord::default()
        };
        let packet = Packet::Record(record);
        assert_eq!(received(&packet), Some(packet));
        let framed = wire::frame(&packet);
        assert_eq!(framed.len(), wire::RECORD_FRAME_BYTES);
        // A zero, its code, no record's sequence, and a code in place of the next zero.
        assert_eq!(framed[..7], [0, 1, 5, 1, 2, 3, 4]);
    }
}
