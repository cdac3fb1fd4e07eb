//! Messages between nodes, as frames.
//!
//! The identifier is the kind in its upper six bits and the node in its lower five: of two
//! messages the more urgent goes first, then the lower node's. Integers are little-endian.
//!
//! | kind | message | bytes |
//! |---|---|---|
//! | 1 | stop | stamp |
//! | 2 | time | number, time of the one before (µs, six bytes) |
//! | 3, 4 | ψ of the left, of the right | stamp, ψ₁, ψ₂ (three bytes each, Q22) |
//! | 5 | arm | stamp |
//! | 6 | contact | stamp, flags and above them the round (6 bits), left, right (two bytes each, Q15) |
//! | 7 | decision | stamp, class, posterior (Q15, two bytes), samples (four bytes) |
//! | 8 | evidence | stamp, leader and part; in six bytes three deficits (12 bits each) and two excesses (6 bits each) |

use crate::{Frame, MAX_NODES};

/// 1 in Q22.
pub const Q22_ONE: i32 = 1 << 22;

/// Classes that a message of evidence says something of, beside the leader.
pub const OTHERS: usize = 3;

/// What a node feels, and how it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Contact {
    /// Contact π of its whiskers of each side, the largest, Q15, up to almost 2; left first.
    pub pi: [u16; 2],
    /// Whether it shares the clock and the oscillators of the head.
    pub is_joined: bool,
    /// Whether its motors are armed.
    pub is_armed: bool,
    /// Which round of 256 ticks its stamp is in ([`Contact::round`]): what is felt must not be believed
    /// a round later.
    pub round: u8,
}

impl Contact {
    /// The round of a tick, 0 to 63: at 2 kHz they are 8.2 s.
    pub const fn round(tick: u32) -> u8 {
        (tick >> 8) as u8 & 63
    }
}

/// What a node's whiskers have felt of what they touch, all since the last decision.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Evidence {
    /// The class that is likeliest by it.
    pub leader: u8,
    /// Which classes the deficits are of: from the `part` · 3-th on, the leader left out.
    pub part: u8,
    /// By how much each lies behind the leader, 2⁻⁶ bits, at most
    /// [`MOST_DEFICIT`](Self::MOST_DEFICIT).
    pub deficits: [u16; OTHERS],
    /// By how much the leader exceeds its floors, of samples and of roughness, bits, within
    /// [`EXCESS`](Self::EXCESS).
    pub excess: [i8; 2],
}

impl Evidence {
    /// Most that fits a message; more loses its upper bits.
    pub const MOST_DEFICIT: u16 = (1 << DEFICIT) - 1;
    /// Least and most excess that fit.
    pub const EXCESS: [i8; 2] = [-(1 << (EXCESS - 1)), (1 << (EXCESS - 1)) - 1];
}

/// What a node says to all others.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Message {
    /// All motors go off, until an [`Arm`](Self::Arm) that is made later.
    Stop,
    /// The time of the node whose clock is the head's.
    Time {
        /// Counts the messages of time.
        number: u8,
        /// When the message before this ended, µs; 48 bits.
        last_us: u64,
    },
    /// ψ of a side, by the node that leads it.
    Psi {
        /// 0: the left.
        side: u8,
        /// ψ, Q22.
        psi: [i32; 2],
    },
    /// All motors are armed.
    Arm,
    /// What it feels.
    Contact(Contact),
    /// The whiskers of the head together have decided.
    Decision {
        /// The number of the class; none: it is unknown.
        class: Option<u8>,
        /// Its posterior, Q15.
        posterior: u16,
        /// Samples of all whiskers.
        samples: u32,
    },
    /// What its whiskers know of what they touch.
    Evidence(Evidence),
}

/// A frame that is no message: of another kind or length, or out of range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NotAMessage;

const STOP: u16 = 1;
const TIME: u16 = 2;
const PSI: u16 = 3;
const ARM: u16 = 5;
const CONTACT: u16 = 6;
const DECISION: u16 = 7;
const EVIDENCE: u16 = 8;

const JOINED: u8 = 1;
const ARMED: u8 = 2;
const ROUND: u8 = 2;
const UNKNOWN: u8 = 0xff;

/// |ψ| ≤ 1.5, and as much again for noise.
const MOST_PSI: i32 = 2 * Q22_ONE - 1;

/// Bits of a deficit, and of an excess.
const DEFICIT: usize = 12;
const EXCESS: usize = 6;

/// Numbers of so many bits each, the first in the lowest.
fn packed<const N: usize>(numbers: [u64; N], bits: usize) -> u64 {
    let least = |number: u64| number & ((1 << bits) - 1);
    numbers
        .iter()
        .rev()
        .fold(0, |all, number| all << bits | least(*number))
}

fn unpacked<const N: usize>(all: u64, bits: usize) -> [u64; N] {
    core::array::from_fn(|n| all >> (n * bits) & ((1 << bits) - 1))
}

fn q22([a, b, c]: [u8; 3]) -> i32 {
    i32::from_le_bytes([0, a, b, c]) >> 8
}

impl Message {
    /// As a frame of node `from`, made after a tick with this `stamp`.
    pub fn frame(&self, from: u8, stamp: u8) -> Frame {
        let frame = |kind: u16, bytes: &[u8]| Frame::new(kind << 5 | u16::from(from & 31), bytes);
        match *self {
            Self::Stop => frame(STOP, &[stamp]),
            Self::Time { number, last_us } => {
                let [a, b, c, d, e, f, ..] = last_us.to_le_bytes();
                frame(TIME, &[number, a, b, c, d, e, f])
            }
            Self::Psi { side, psi } => {
                let psi = psi.map(|x| x.clamp(-MOST_PSI, MOST_PSI).to_le_bytes());
                let [[a, b, c, _], [d, e, f, _]] = psi;
                frame(PSI + u16::from(side & 1), &[stamp, a, b, c, d, e, f])
            }
            Self::Arm => frame(ARM, &[stamp]),
            Self::Contact(Contact {
                pi,
                is_joined,
                is_armed,
                round,
            }) => {
                let flags = u8::from(is_joined) * JOINED + u8::from(is_armed) * ARMED;
                let flags = flags | round << ROUND;
                let [[a, b], [c, d]] = pi.map(u16::to_le_bytes);
                frame(CONTACT, &[stamp, flags, a, b, c, d])
            }
            Self::Decision {
                class,
                posterior,
                samples,
            } => {
                let [a, b] = posterior.to_le_bytes();
                let [c, d, e, f] = samples.to_le_bytes();
                let class = class.unwrap_or(UNKNOWN);
                frame(DECISION, &[stamp, class, a, b, c, d, e, f])
            }
            Self::Evidence(Evidence {
                leader,
                part,
                deficits,
                excess,
            }) => {
                let deficits = packed(deficits.map(u64::from), DEFICIT);
                let excess = packed(excess.map(|bits| i64::from(bits).cast_unsigned()), EXCESS);
                let all = deficits | excess << (OTHERS * DEFICIT);
                let [a, b, c, d, e, f, ..] = all.to_le_bytes();
                let first = leader & 15 | part << 4;
                frame(EVIDENCE, &[stamp, first, a, b, c, d, e, f])
            }
        }
    }

    /// The message of a frame, with who says it and its stamp (0 of a message of time).
    ///
    /// # Errors
    /// [`NotAMessage`], whatever the bytes.
    pub fn of(frame: &Frame) -> Result<(u8, u8, Self), NotAMessage> {
        let from = (frame.id() & 31) as u8;
        if usize::from(from) >= MAX_NODES {
            return Err(NotAMessage);
        }
        let kind = frame.id() >> 5;
        let (stamp, message) = match (kind, frame.bytes()) {
            (STOP, &[stamp]) => (stamp, Self::Stop),
            (TIME, &[number, a, b, c, d, e, f]) => {
                let last_us = u64::from_le_bytes([a, b, c, d, e, f, 0, 0]);
                (0, Self::Time { number, last_us })
            }
            (PSI | 4, &[stamp, a, b, c, d, e, f]) => {
                let psi = [q22([a, b, c]), q22([d, e, f])];
                let side = (kind - PSI) as u8;
                (stamp, Self::Psi { side, psi })
            }
            (ARM, &[stamp]) => (stamp, Self::Arm),
            (CONTACT, &[stamp, flags, a, b, c, d]) => {
                let contact = Contact {
                    pi: [[a, b], [c, d]].map(u16::from_le_bytes),
                    is_joined: flags & JOINED > 0,
                    is_armed: flags & ARMED > 0,
                    round: flags >> ROUND,
                };
                (stamp, Self::Contact(contact))
            }
            (DECISION, &[stamp, class, a, b, c, d, e, f]) => {
                let decision = Self::Decision {
                    class: (class != UNKNOWN).then_some(class),
                    posterior: u16::from_le_bytes([a, b]),
                    samples: u32::from_le_bytes([c, d, e, f]),
                };
                (stamp, decision)
            }
            (EVIDENCE, &[stamp, first, a, b, c, d, e, f]) => {
                let all = u64::from_le_bytes([a, b, c, d, e, f, 0, 0]);
                let of_excess = unpacked(all >> (OTHERS * DEFICIT), EXCESS);
                let evidence = Evidence {
                    leader: first & 15,
                    part: first >> 4,
                    deficits: unpacked(all, DEFICIT).map(|number| number as u16),
                    // Of six bits the highest is the sign.
                    excess: of_excess.map(|number| (number << 2) as i8 >> 2),
                };
                (stamp, Self::Evidence(evidence))
            }
            _ => return Err(NotAMessage),
        };
        Ok((from, stamp, message))
    }
}

#[cfg(test)]
mod tests {
    use super::{Contact, Evidence, MOST_PSI, Message, NotAMessage};
    use crate::{Frame, MAX_NODES};
    use proptest::array::{uniform2, uniform3};
    use proptest::prelude::*;

    prop_compose! {
        fn contact()(pi: [u16; 2], is_joined: bool, is_armed: bool, round in 0_u8..64) -> Contact {
            Contact { pi, is_joined, is_armed, round }
        }
    }

    prop_compose! {
        fn evidence()(
            leader in 0_u8..16,
            part in 0_u8..16,
            deficits in uniform3(0_u16..4096),
            excess in uniform2(-32_i8..32),
        ) -> Evidence {
            Evidence { leader, part, deficits, excess }
        }
    }

    fn any_message() -> impl Strategy<Value = Message> {
        let psi = -MOST_PSI..=MOST_PSI;
        prop_oneof![
            Just(Message::Stop),
            Just(Message::Arm),
            (any::<u8>(), 0_u64..1 << 48)
                .prop_map(|(number, last_us)| Message::Time { number, last_us }),
            (0_u8..2, psi.clone(), psi).prop_map(|(side, a, b)| Message::Psi { side, psi: [a, b] }),
            contact().prop_map(Message::Contact),
            (proptest::option::of(0_u8..8), any::<u16>(), any::<u32>()).prop_map(
                |(class, posterior, samples)| Message::Decision {
                    class,
                    posterior,
                    samples
                }
            ),
            evidence().prop_map(Message::Evidence),
        ]
    }

    proptest! {
        #[test]
        fn a_frame_is_its_message(
            message in any_message(),
            from in 0_u8..MAX_NODES as u8,
            stamp in any::<u8>(),
        ) {
            let (who, when, what) = Message::of(&message.frame(from, stamp)).unwrap();
            prop_assert_eq!((who, what), (from, message));
            let has_stamp = !matches!(message, Message::Time { .. });
            prop_assert_eq!(when, if has_stamp { stamp } else { 0 });
        }

        /// What is read from any bytes makes the same bytes again.
        #[test]
        fn any_bytes_are_a_message_or_none(
            id in 0_u16..0x800,
            data in proptest::collection::vec(any::<u8>(), 0..=8),
        ) {
            let frame = Frame::new(id, &data);
            match Message::of(&frame) {
                Err(NotAMessage) => {}
                Ok((from, stamp, message @ Message::Psi { psi, .. })) => {
                    // The one value that no node sends.
                    let is_sent = psi.iter().all(|x| x.abs() <= MOST_PSI);
                    prop_assert!(!is_sent || message.frame(from, stamp) == frame);
                }
                Ok((from, stamp, message)) => prop_assert_eq!(message.frame(from, stamp), frame),
            }
        }
    }

    /// As the table above says, by hand.
    #[test]
    fn evidence_lies_where_the_page_says() {
        let evidence = Evidence {
            leader: 2,
            part: 1,
            deficits: [0x001, 0x123, 0xfff],
            excess: [-1, 31],
        };
        let frame = Message::Evidence(evidence).frame(5, 7);
        assert_eq!(frame.id(), 8 << 5 | 5);
        assert_eq!(frame.bytes(), [7, 0x12, 0x01, 0x30, 0x12, 0xff, 0xff, 0x7f]);
    }

    /// A stop goes before all else, whoever says it; and of ψ the left before the right.
    #[test]
    fn the_more_urgent_has_the_lower_identifier() {
        let (number, last_us, psi) = (0, 0, [0; 2]);
        let others = [
            Message::Time { number, last_us },
            Message::Psi { side: 0, psi },
            Message::Psi { side: 1, psi },
            Message::Arm,
            Message::Contact(Contact::default()),
        ];
        let others = others.map(|message| message.frame(0, 0).id());
        assert!(others.is_sorted_by(|a, b| a < b));
        let stop = Message::Stop.frame(MAX_NODES as u8 - 1, 0);
        assert!(stop.id() < others[0]);
    }
}
