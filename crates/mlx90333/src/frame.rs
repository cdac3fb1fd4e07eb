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
//! All words are little-endian. Certainty: several drivers agree on B0..B6 of
//! alpha-beta, two sources on XYZ; which bytes B7 sums is uncertain, hence
//! [`SumRule`].

use core::fmt;

use crate::{FRAME_LEN, Faults, START_BYTE, Word};

/// What the three words of a frame mean. Set in the sensor's EEPROM; the frame
/// itself does not tell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Mode {
    /// Two angles and an error word.
    #[default]
    AlphaBeta,
    /// Three field components and no error word: the sensor cannot report
    /// [`Faults`].
    Xyz,
}

/// How B7 follows from the other bytes. Sums wrap modulo 256.
///
/// With s = B1 + … + B6 and B0 = 0xFF, the four sums are s, s − 1, −s − 1 and
/// −s in the order below. The first and the fourth, and the second and the
/// third, agree on the frames with s = 0 or 128; no other two agree on any.
///
/// Each of the four catches every change of one bit, and every burst of up to
/// eight consecutive bits. It catches 255 in 256 of random frames and does not
/// see two bytes that changed places.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
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
    #[inline]
    pub const fn expected(self, bytes: &[u8; FRAME_LEN]) -> Option<u8> {
        let [b0, ..] = *bytes;
        match self.sum(b0, words(bytes)) {
            Some(sum) => Some(sum as u8),
            None => None,
        }
    }

    /// The same of B0 and the words B1..B6, in the low byte: what stands above
    /// it is of no use, and cutting it off can wait.
    #[inline]
    const fn sum(self, b0: u8, [first, second, last]: [u16; 3]) -> Option<u32> {
        // At most 1021 · 257.
        let inner = byte_sum(first) + byte_sum(second) + byte_sum(last);
        match self {
            SumRule::SumB1B6 => Some(inner),
            SumRule::SumB0B6 => Some(inner + b0 as u32),
            SumRule::ComplementB1B6 => Some(!inner),
            SumRule::ComplementB0B6 => Some(!(inner + b0 as u32)),
            SumRule::Ignore => None,
        }
    }
}

/// A valid frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Frame {
    /// The words of [`Mode::AlphaBeta`].
    AlphaBeta {
        /// First angle.
        alpha: Word,
        /// Second angle.
        beta: Word,
    },
    /// The words of [`Mode::Xyz`].
    Xyz {
        /// Field along X.
        x: Word,
        /// Field along Y.
        y: Word,
        /// Field along Z.
        z: Word,
    },
}

impl Frame {
    /// Alpha or X.
    #[inline]
    pub const fn first(&self) -> Word {
        match *self {
            Frame::AlphaBeta { alpha, .. } => alpha,
            Frame::Xyz { x, .. } => x,
        }
    }

    /// Beta or Y.
    #[inline]
    pub const fn second(&self) -> Word {
        match *self {
            Frame::AlphaBeta { beta, .. } => beta,
            Frame::Xyz { y, .. } => y,
        }
    }

    /// Z; `None` in alpha-beta mode.
    #[inline]
    pub const fn third(&self) -> Option<Word> {
        match *self {
            Frame::AlphaBeta { .. } => None,
            Frame::Xyz { z, .. } => Some(z),
        }
    }
}

/// Why eight bytes are not a valid frame. The first that applies, in the order
/// given here, is the one reported.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum FrameError {
    /// All bytes 0xFF: nobody drove the line. Likely cause: /SS or the data
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
        }
    }
}

impl core::error::Error for FrameError {}

/// How to read a frame: fixed settings and no state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Decoder {
    /// What the words mean.
    pub mode: Mode,
    /// How the sum byte is checked.
    pub sum_rule: SumRule,
}

impl Decoder {
    /// Alpha-beta mode with the default sum rule.
    #[inline]
    pub const fn new() -> Decoder {
        Decoder::with(Mode::AlphaBeta, SumRule::SumB1B6)
    }

    /// The given mode with the default sum rule.
    #[inline]
    pub const fn with_mode(mode: Mode) -> Decoder {
        Decoder::with(mode, SumRule::SumB1B6)
    }

    /// The given mode and sum rule.
    #[inline]
    pub const fn with(mode: Mode, sum_rule: SumRule) -> Decoder {
        Decoder { mode, sum_rule }
    }

    /// Decodes a frame. Any eight bytes give an answer.
    ///
    /// With constant settings and the default rule a valid frame in alpha-beta
    /// mode costs 20 instructions on a Cortex-M4, call and return included, and
    /// 35 on a Cortex-M0 (rustc 1.95, optimised).
    ///
    /// # Errors
    ///
    /// The first [`FrameError`] that applies, in the order they are listed.
    #[inline]
    pub const fn decode(&self, bytes: &[u8; FRAME_LEN]) -> Result<Frame, FrameError> {
        let [b0, .., found] = *bytes;
        let [first, second, last] = words(bytes);
        let alpha_beta = matches!(self.mode, Mode::AlphaBeta);
        // A frame with faults does not pass anyhow, and those without are
        // shorter to sum.
        let (faults, z) = if alpha_beta { (last, 0) } else { (0, last) };
        let wrong_sum = match self.sum_rule.sum(b0, [first, second, z]) {
            Some(sum) => sum.wrapping_sub(found as u32),
            // All-0xFF is no frame. The four sums of it are 0xFA, 0xF9, 0x05
            // and 0x06, so that no other rule lets it pass.
            None => (u64::from_le_bytes(*bytes) == u64::MAX) as u32,
        };
        // All that can be wrong in one word, for one branch: zero where nothing
        // is. The order of the reports is `reject`'s affair.
        if (b0 ^ START_BYTE) as u32 | faults as u32 | wrong_sum << 24 != 0 {
            return Err(self.reject(u64::from_le_bytes(*bytes)));
        }
        Ok(if alpha_beta {
            Frame::AlphaBeta {
                alpha: Word::new(first),
                beta: Word::new(second),
            }
        } else {
            Frame::Xyz {
                x: Word::new(first),
                y: Word::new(second),
                z: Word::new(last),
            }
        })
    }

    /// Names what is wrong with a frame that did not pass. It comes as a
    /// number: a reference would hold it in memory on the good path too.
    #[cold]
    #[inline(never)]
    const fn reject(self, bits: u64) -> FrameError {
        match bits {
            u64::MAX => return FrameError::NoSensor,
            0 => return FrameError::LineLow,
            _ => {}
        }
        let bytes = bits.to_le_bytes();
        let [start, .., error_low, error_high, found] = bytes;
        if start != START_BYTE {
            return FrameError::BadStart(start);
        }
        match self.sum_rule.expected(&bytes) {
            Some(expected) if expected != found => FrameError::BadSum { expected, found },
            _ => FrameError::Sensor(Faults::new(u16::from_le_bytes([error_low, error_high]))),
        }
    }
}

/// The three words, each taken from memory whole: put together from bytes they
/// would cost the good path a third more instructions.
#[inline]
#[allow(
    clippy::trivially_copy_pass_by_ref,
    reason = "a copy hides that the words lie in memory"
)]
const fn words(bytes: &[u8; FRAME_LEN]) -> [u16; 3] {
    let [_, first @ .., _, _, _, _, _] = bytes;
    let [_, _, _, second @ .., _, _, _] = bytes;
    let [_, _, _, _, _, last @ .., _] = bytes;
    [
        u16::from_le_bytes(*first),
        u16::from_le_bytes(*second),
        u16::from_le_bytes(*last),
    ]
}

/// The sum of a word's two bytes modulo 256, in the low byte.
#[inline]
const fn byte_sum(word: u16) -> u32 {
    word as u32 + (word >> 8) as u32
}
