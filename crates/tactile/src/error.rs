//! What can be wrong with a model file or with the settings of a rule.
//!
//! All checks happen before the first sample; the streaming step can only
//! refuse a sample of another number of channels.

use crate::format::{MAX_STREAMS, VERSION};
use crate::name::NameError;

/// Why a model file is refused. Classes and channels are counted from zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say it")]
pub enum ModelError {
    #[error("the model is cut short")]
    TooShort,
    #[error("not a likelihood model: it does not begin with WLIK")]
    BadMagic,
    #[error("model format version {0}; 2 to {VERSION} are understood: train it again")]
    UnknownVersion(u16),
    #[error("bytes follow the end of the model")]
    TrailingBytes,
    #[error("the model's header contradicts its length")]
    Length,
    #[error("the model is damaged: its CRC-32 does not match")]
    Checksum,
    #[error("the model does not start on a four-byte boundary")]
    Misaligned,
    #[error("{0} classes; 2 to 32 are allowed")]
    Classes(usize),
    #[error("{0} channels; 1 to 24 are allowed")]
    Channels(usize),
    #[error("{0} tables; 1 to 24 are allowed, one of them of samples")]
    Tables(usize),
    #[error(
        "more than 24 axes of tables of samples, or more of roughness than one of each of the \
         first two channels"
    )]
    Axes,
    #[error("the gate of touches is not 0 to 1, or stands without a limit")]
    TouchRule,
    #[error("{0} bins; 1 to 4096 are allowed")]
    Bins(usize),
    #[error("a block of {0} samples; 1 to 10000 are allowed")]
    Block(u32),
    #[error("block times channels is {0}; at most 65535 is allowed")]
    BlockTimesChannels(u32),
    #[error("quantiser of channel {channel}: {reason}")]
    Quantiser {
        channel: usize,
        reason: QuantiserError,
    },
    #[error("the name of class {class} is empty or longer than 255 bytes")]
    NameLength { class: usize },
    #[error("the name of class {class} is not UTF-8")]
    NameNotUtf8 { class: usize },
    #[error("the name of class {class} {reason}")]
    Name { class: usize, reason: NameError },
    #[error("bytes reserved as zero are not zero")]
    Padding,
    #[error("the opinion's counts contradict its length")]
    Opinion,
    #[error("the log-likelihoods of a block can overflow: a shorter block is needed")]
    TableEntry,
}

/// Why a quantiser is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say it")]
pub enum QuantiserError {
    #[error("the origin is not a finite number")]
    Origin,
    #[error("scale exponent {0}; -1000 to 1000 is allowed")]
    Exponent(i32),
    #[error("the upper edge lies below the lower")]
    Reversed,
    #[error("a range of {0} codes; none, or from above twice the bins to below 2^31 is allowed")]
    Span(u32),
}

/// Why a rule cannot be built for a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say it")]
pub enum SetupError {
    #[error("the threshold must lie above 0 and be at most 1 - 1e-12")]
    Threshold,
    #[error("a window of {window} samples; a multiple of the block of {block} is needed")]
    Window { window: u32, block: u32 },
    #[error(
        "a model that was trained in several poses decides in touches: the rule must be sequential"
    )]
    WindowNames,
    #[error(
        "several whiskers cannot decide together by windows: a window counts the samples of one"
    )]
    WindowTogether,
    #[error("{0} whiskers to hear; 1 to {MAX_STREAMS} are allowed")]
    Whiskers(usize),
    #[error("the program was built without this: {0}")]
    NotBuilt(&'static str),
}
