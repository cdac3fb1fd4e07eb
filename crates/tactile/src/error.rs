//! What can be wrong with a model file or with the settings of a rule.
//!
//! All checks happen before the first sample; the streaming step can only
//! refuse a sample of another number of channels.

use crate::format::{MAX_STREAMS, VERSION};
use crate::name::NameError;

/// Why a model file is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ModelError {
    /// Fewer bytes than the smallest model, or than its header announces.
    #[error("the model is cut short")]
    TooShort,
    /// The file does not begin with the model magic: it is something else.
    #[error("not a likelihood model: it does not begin with WLIK")]
    BadMagic,
    /// Written by another version of the format.
    #[error("model format version {0}; 2 to {VERSION} are understood: train it again")]
    UnknownVersion(u16),
    /// More bytes than its header announces.
    #[error("bytes follow the end of the model")]
    TrailingBytes,
    /// The header's counts do not add up to its length.
    #[error("the model's header contradicts its length")]
    Length,
    /// The checksum does not match: the file is damaged.
    #[error("the model is damaged: its CRC-32 does not match")]
    Checksum,
    /// The bytes do not start on a four-byte boundary: see [`crate::include_model`].
    #[error("the model does not start on a four-byte boundary")]
    Misaligned,
    /// The number of classes is not 2 to 32.
    #[error("{0} classes; 2 to 32 are allowed")]
    Classes(usize),
    /// The number of channels is not 1 to 24.
    #[error("{0} channels; 1 to 24 are allowed")]
    Channels(usize),
    /// There is no table of samples, or more than 24 tables.
    #[error("{0} tables; 1 to 24 are allowed, one of them of samples")]
    Tables(usize),
    /// More than 24 axes of tables of samples, or more than two of roughness, or
    /// roughness of another than the first two channels.
    #[error(
        "more than 24 axes of tables of samples, or more of roughness than one of each of the \
         first two channels"
    )]
    Axes,
    /// The rule of touches is out of range.
    #[error("the gate of touches is not 0 to 1, or stands without a limit")]
    TouchRule,
    /// The number of bins is not 1 to 4096.
    #[error("{0} bins; 1 to 4096 are allowed")]
    Bins(usize),
    /// The block is not 1 to 10000 samples.
    #[error("a block of {0} samples; 1 to 10000 are allowed")]
    Block(u32),
    /// Block times channels is above 65535, where sums could overflow.
    #[error("block times channels is {0}; at most 65535 is allowed")]
    BlockTimesChannels(u32),
    /// A channel's quantiser is unusable.
    #[error("quantiser of channel {channel}: {reason}")]
    Quantiser {
        /// The channel, from zero.
        channel: usize,
        /// What is wrong with it.
        reason: QuantiserError,
    },
    /// A class has an empty name, or one of more than 255 bytes.
    #[error("the name of class {class} is empty or longer than 255 bytes")]
    NameLength {
        /// The class, from zero.
        class: usize,
    },
    /// A class's name is not UTF-8.
    #[error("the name of class {class} is not UTF-8")]
    NameNotUtf8 {
        /// The class, from zero.
        class: usize,
    },
    /// A class's name is one that no class may have (see [`crate::name`]).
    #[error("the name of class {class} {reason}")]
    Name {
        /// The class, from zero.
        class: usize,
        /// What is wrong with it.
        reason: NameError,
    },
    /// Bytes that the format keeps at zero are not.
    #[error("bytes reserved as zero are not zero")]
    Padding,
    /// The counts of the opinion are out of range, or do not add up to its length.
    #[error("the opinion's counts contradict its length")]
    Opinion,
    /// The log-likelihoods of a block can sum up to too much.
    #[error("the log-likelihoods of a block can overflow: a shorter block is needed")]
    TableEntry,
}

/// Why a quantiser is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum QuantiserError {
    /// The origin is infinite or not a number.
    #[error("the origin is not a finite number")]
    Origin,
    /// The exponent of the scale is outside −1000 to 1000.
    #[error("scale exponent {0}; -1000 to 1000 is allowed")]
    Exponent(i32),
    /// The upper edge lies below the lower.
    #[error("the upper edge lies below the lower")]
    Reversed,
    /// The range is not a single code, yet has no more than two codes a bin,
    /// or is 2³¹ codes or more.
    #[error("a range of {0} codes; none, or from above twice the bins to below 2^31 is allowed")]
    Span(u32),
}

/// Why a rule cannot be built for a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SetupError {
    /// The threshold is not above 0 and at most 1 − 1e-12.
    #[error("the threshold must lie above 0 and be at most 1 - 1e-12")]
    Threshold,
    /// The window is zero, or not a multiple of the model's block.
    #[error("a window of {window} samples; a multiple of the block of {block} is needed")]
    Window {
        /// The window asked for, samples.
        window: u32,
        /// The model's block, samples.
        block: u32,
    },
    /// A model whose opinion names classes knows no windows.
    #[error(
        "a model that was trained in several poses decides in touches: the rule must be sequential"
    )]
    WindowNames,
    /// Windows of several whiskers cannot be added up.
    #[error(
        "several whiskers cannot decide together by windows: a window counts the samples of one"
    )]
    WindowTogether,
    /// There are no whiskers to hear, or more than the program hears.
    #[error("{0} whiskers to hear; 1 to {MAX_STREAMS} are allowed")]
    Whiskers(usize),
    /// A part that the program was built without.
    #[error("the program was built without this: {0}")]
    NotBuilt(&'static str),
}
