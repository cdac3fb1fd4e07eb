//! What can be wrong with a model file or with the settings of a rule.
//!
//! All checks happen before the first sample; the streaming step can only
//! refuse a sample of another number of channels.

use core::fmt;

use crate::format::VERSION;

/// Why a model file is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ModelError {
    /// Fewer bytes than the smallest model, or than its header announces.
    TooShort,
    /// The file does not begin with the model magic: it is something else.
    BadMagic,
    /// Written by another version of the format.
    UnknownVersion(u16),
    /// More bytes than its header announces.
    TrailingBytes,
    /// The header's counts do not add up to its length.
    Length,
    /// The checksum does not match: the file is damaged.
    Checksum,
    /// The bytes do not start on a four-byte boundary: see [`crate::include_model`].
    Misaligned,
    /// The number of classes is not 2 to 32.
    Classes(usize),
    /// The number of channels is not 1 to 24.
    Channels(usize),
    /// The number of bins is not 1 to 4096.
    Bins(usize),
    /// The block is not 1 to 10000 samples.
    Block(u32),
    /// Block times channels is above 65535, where sums could overflow.
    BlockTimesChannels(u32),
    /// A channel's quantiser is unusable.
    Quantiser {
        /// The channel, from zero.
        channel: usize,
        /// What is wrong with it.
        reason: QuantiserError,
    },
    /// A class has an empty name, or one of more than 255 bytes.
    NameLength {
        /// The class, from zero.
        class: usize,
    },
    /// A class's name is not UTF-8.
    NameNotUtf8 {
        /// The class, from zero.
        class: usize,
    },
    /// Bytes that the format keeps at zero are not.
    Padding,
    /// A log-likelihood lies outside its range.
    TableEntry,
}

/// Why a quantiser is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum QuantiserError {
    /// The origin is infinite or not a number.
    Origin,
    /// The exponent of the scale is outside −1000 to 1000.
    Exponent(i32),
    /// The upper edge lies below the lower.
    Reversed,
    /// The range is not a single code, yet has no more than two codes a bin,
    /// or is 2³¹ codes or more.
    Span(u32),
}

/// Why a rule cannot be built for a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum SetupError {
    /// The threshold is not above 0 and at most 1 − 1e-12.
    Threshold,
    /// The window is zero, or not a multiple of the model's block.
    Window {
        /// The window asked for, samples.
        window: u32,
        /// The model's block, samples.
        block: u32,
    },
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooShort => f.write_str("the model is cut short"),
            Self::BadMagic => f.write_str("not a likelihood model: it does not begin with WLIK"),
            Self::UnknownVersion(found) => {
                write!(
                    f,
                    "model format version {found}; version {VERSION} is understood"
                )
            }
            Self::TrailingBytes => f.write_str("bytes follow the end of the model"),
            Self::Length => f.write_str("the model's header contradicts its length"),
            Self::Checksum => f.write_str("the model is damaged: its CRC-32 does not match"),
            Self::Misaligned => f.write_str("the model does not start on a four-byte boundary"),
            Self::Classes(n) => write!(f, "{n} classes; 2 to 32 are allowed"),
            Self::Channels(n) => write!(f, "{n} channels; 1 to 24 are allowed"),
            Self::Bins(n) => write!(f, "{n} bins; 1 to 4096 are allowed"),
            Self::Block(n) => write!(f, "a block of {n} samples; 1 to 10000 are allowed"),
            Self::BlockTimesChannels(n) => {
                write!(f, "block times channels is {n}; at most 65535 is allowed")
            }
            Self::Quantiser { channel, reason } => {
                write!(f, "quantiser of channel {channel}: {reason}")
            }
            Self::NameLength { class } => {
                write!(
                    f,
                    "the name of class {class} is empty or longer than 255 bytes"
                )
            }
            Self::NameNotUtf8 { class } => write!(f, "the name of class {class} is not UTF-8"),
            Self::Padding => f.write_str("bytes reserved as zero are not zero"),
            Self::TableEntry => f.write_str("a log-likelihood lies outside its range"),
        }
    }
}

impl fmt::Display for QuantiserError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Origin => f.write_str("the origin is not a finite number"),
            Self::Exponent(e) => write!(f, "scale exponent {e}; -1000 to 1000 is allowed"),
            Self::Reversed => f.write_str("the upper edge lies below the lower"),
            Self::Span(n) => write!(
                f,
                "a range of {n} codes; none, or from above twice the bins to below 2^31 is allowed"
            ),
        }
    }
}

impl fmt::Display for SetupError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Threshold => {
                f.write_str("the threshold must lie above 0 and be at most 1 - 1e-12")
            }
            Self::Window { window, block } => write!(
                f,
                "a window of {window} samples; a multiple of the block of {block} is needed"
            ),
        }
    }
}

impl core::error::Error for ModelError {}
impl core::error::Error for QuantiserError {}
impl core::error::Error for SetupError {}
