//! The eight-byte frame: its two modes, its sum byte and its decoder.
//!
//! | byte | alpha-beta | XYZ |
//! |---|---|---|
//! | B0 | 0xFF | 0xFF |
//! | B1, B2 | alpha | X |
//! | B3, B4 | beta | Y |
//! | B5, B6 | error word | Z |
//! | B7 | sum | sum |
//!
//! Certainty: several drivers agree on B0..B6 of alpha-beta, all but one on little-endian words
//! ([`ByteOrder`]), two sources on XYZ; which bytes B7 sums is uncertain, hence [`SumRule`].

use core::fmt;

use crate::{FRAME_LEN, Faults, START_BYTE, Word};

/// What the three words of a frame mean. Set in the sensor's EEPROM; the frame
/// itself does not tell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Mode {
    /// Two angles and an error word.
    #[default]
    AlphaBeta,
    /// Three field components and no error word: the sensor cannot report
    /// [`Faults`].
    Xyz,
}

/// In which order the two bytes of a word come.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ByteOrder {
    /// The low byte first: four drivers.
    #[default]
    Little,
    /// The high byte first: one driver.
    Big,
}

impl ByteOrder {
    /// The number in two bytes as they come.
    pub const fn number(self, bytes: [u8; 2]) -> u16 {
        match self {
            Self::Little => u16::from_le_bytes(bytes),
            Self::Big => u16::from_be_bytes(bytes),
        }
    }

    /// The bytes of a number as they come.
    pub const fn bytes(self, number: u16) -> [u8; 2] {
        match self {
            Self::Little => number.to_le_bytes(),
            Self::Big => number.to_be_bytes(),
        }
    }
}

/// How B7 follows from the other bytes. Sums wrap modulo 256.
///
/// With s = B1 + … + B6 and B0 = 0xFF, the four sums are s, s − 1, −s − 1 and
/// −s in the order below. The first and the fourth, and the second and the
/// third, agree on the frames with s = 0 or 128; no other two agree on any.
///
/// Each of the four catches every change of one bit, and every burst of up to eight consecutive
/// bits. It catches 255 in 256 of random frames and does not see two bytes that changed places.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum SumRule {
    /// B7 = B1 + … + B6.
    #[default]
    SumB1B6,
    /// B7 = B0 + … + B6.
    SumB0B6,
    /// B7 = NOT (B1 + … + B6).
    ComplementB1B6,
    /// B7 = NOT (B0 + … + B6), so that all eight bytes sum to 0xFF.
    ComplementB0B6,
    /// B7 is not looked at: a damaged frame passes for a reading.
    Ignore,
}

impl SumRule {
    /// Every rule, for finding out which one a real part follows: the one that
    /// some thousand frames of a moving magnet all agree with.
    pub const ALL: [SumRule; 5] = [
        SumRule::SumB1B6,
        SumRule::SumB0B6,
        SumRule::ComplementB1B6,
        SumRule::ComplementB0B6,
        SumRule::Ignore,
    ];

    /// The B7 that the rule wants after B0..B6; `None` if it takes any.
    pub const fn expected(self, bytes: &[u8; FRAME_LEN]) -> Option<u8> {
        let [b0, b1, b2, b3, b4, b5, b6, _] = *bytes;
        let inner = b1
            .wrapping_add(b2)
            .wrapping_add(b3)
            .wrapping_add(b4)
            .wrapping_add(b5)
            .wrapping_add(b6);
        match self {
            SumRule::SumB1B6 => Some(inner),
            SumRule::SumB0B6 => Some(inner.wrapping_add(b0)),
            SumRule::ComplementB1B6 => Some(!inner),
            SumRule::ComplementB0B6 => Some(!inner.wrapping_add(b0)),
            SumRule::Ignore => None,
        }
    }
}

/// A valid frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Frame {
    /// Alpha or X.
    pub first: Word,
    /// Beta or Y.
    pub second: Word,
    /// Z; `None` in alpha-beta mode.
    pub third: Option<Word>,
}

/// Why eight bytes are not a valid frame. The first that applies, in the order
/// given here, is the one reported.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FrameError {
    /// All bytes 0xFF: nothing drove the line. Likely cause: /SS or the data
    /// line open, no supply, or the sensor still starting up.
    NoSensor,
    /// All bytes 0x00. Likely cause: no pull-up, a short to ground, or a
    /// master that drives the line low.
    LineLow,
    /// B0, given here, is not 0xFF. Likely cause: clock too fast, wrong SPI
    /// mode, or a frame cut short before this one.
    BadStart(u8),
    /// B7 breaks the [`SumRule`]. Likely cause: noise or a slow pull-up; if
    /// every frame fails, the wrong rule.
    BadSum {
        /// What the rule wants.
        expected: u8,
        /// B7.
        found: u8,
    },
    /// An alpha-beta frame arrived whole and the sensor reports faults; its
    /// words are not valid readings.
    Sensor(Faults),
    /// The first two words are both all zeros or both all ones, under a good
    /// sum. Likely cause: the line held low or let go after B0. A deflection to
    /// the very corner of both curves reads so too, and is no use either.
    StuckWords,
}

impl fmt::Display for FrameError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FrameError::NoSensor => f.write_str("no sensor: all bytes 0xff"),
            FrameError::LineLow => f.write_str("data line stuck low: all bytes 0x00"),
            FrameError::BadStart(found) => {
                write!(f, "bad start byte: {found:#04x}, expected 0xff")
            }
            FrameError::BadSum { expected, found } => {
                write!(f, "bad sum byte: {found:#04x}, expected {expected:#04x}")
            }
            FrameError::Sensor(faults) => write!(f, "sensor reports: {faults}"),
            FrameError::StuckWords => f.write_str("both words all zeros or all ones"),
        }
    }
}

impl core::error::Error for FrameError {}

/// How to read a frame: fixed settings and no state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Decoder {
    /// What the words mean.
    pub mode: Mode,
    /// How the sum byte is checked.
    pub sum_rule: SumRule,
    /// How bytes make words.
    pub byte_order: ByteOrder,
}

impl Decoder {
    /// Alpha-beta mode with the default sum rule.
    pub const fn new() -> Decoder {
        Decoder::with(Mode::AlphaBeta, SumRule::SumB1B6)
    }

    /// The given mode and sum rule, and little-endian words.
    pub const fn with(mode: Mode, sum_rule: SumRule) -> Decoder {
        Decoder {
            mode,
            sum_rule,
            byte_order: ByteOrder::Little,
        }
    }

    /// Decodes a frame. Any eight bytes give an answer.
    ///
    /// # Errors
    /// The first [`FrameError`] that applies, in the order they are listed.
    pub const fn decode(&self, bytes: &[u8; FRAME_LEN]) -> Result<Frame, FrameError> {
        self.decode_here(bytes)
    }

    /// The same as part of where it is called, even in a program that is compiled for size: by a
    /// decoder that is a constant, it takes half of the instructions.
    ///
    /// # Errors
    /// As [`Self::decode`].
    #[allow(
        clippy::inline_always,
        reason = "as a call it takes 30 instructions more of a board's tick"
    )]
    #[inline(always)]
    pub const fn decode_here(&self, bytes: &[u8; FRAME_LEN]) -> Result<Frame, FrameError> {
        let [start, b1, b2, b3, b4, b5, b6, found] = *bytes;
        match u64::from_le_bytes(*bytes) {
            u64::MAX => return Err(FrameError::NoSensor),
            _ if start == START_BYTE => {}
            0 => return Err(FrameError::LineLow),
            _ => return Err(FrameError::BadStart(start)),
        }
        if let Some(expected) = self.sum_rule.expected(bytes)
            && expected != found
        {
            return Err(FrameError::BadSum { expected, found });
        }
        let order = self.byte_order;
        let first = Word::new(order.number([b1, b2]));
        let second = Word::new(order.number([b3, b4]));
        let last = order.number([b5, b6]);
        match self.mode {
            Mode::AlphaBeta if last != 0 => Err(FrameError::Sensor(Faults::new(last))),
            _ if matches!([first.raw(), second.raw()], [0, 0] | [u16::MAX, u16::MAX]) => {
                Err(FrameError::StuckWords)
            }
            mode => Ok(Frame {
                first,
                second,
                third: match mode {
                    Mode::AlphaBeta => None,
                    Mode::Xyz => Some(Word::new(last)),
                },
            }),
        }
    }
}
