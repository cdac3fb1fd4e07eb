//! What can be wrong with training data or its options.

use core::fmt;

use crate::error::ModelError;
use crate::format::{MAX_CLASSES, MAX_NAME_BYTES};

/// Why no model can be trained.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum TrainError {
    /// A sample that is infinite or not a number.
    NotFinite {
        /// The channel, from zero.
        channel: usize,
    },
    /// A sample with another number of channels.
    Channels {
        /// As the trainer was made.
        expected: usize,
        /// In the sample.
        found: usize,
    },
    /// No sample at all.
    NoSamples,
    /// All samples are of one class.
    OneClass,
    /// More than 32 classes.
    TooManyClasses,
    /// A class without a name.
    NameEmpty,
    /// A class name of more than 255 bytes.
    NameTooLong {
        /// Its length in bytes.
        bytes: usize,
    },
    /// The smoothing is not between 0 and 4096 bins.
    Smooth(f64),
    /// The range of a channel is too large or too small to scale: wider than
    /// 1e280, or narrower than 1e-280 yet not constant.
    Range {
        /// The channel, from zero.
        channel: usize,
    },
    /// A setting that no model file can hold.
    Model(ModelError),
}

impl fmt::Display for TrainError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { channel } => {
                write!(f, "channel {channel}: a sample is not a finite number")
            }
            Self::Channels { expected, found } => {
                write!(f, "a sample of {found} channels; {expected} are expected")
            }
            Self::NoSamples => f.write_str("there are no samples"),
            Self::OneClass => f.write_str("all samples are of one class; two are needed"),
            Self::TooManyClasses => write!(f, "more than {MAX_CLASSES} classes"),
            Self::NameEmpty => f.write_str("a class has an empty name"),
            Self::NameTooLong { bytes } => {
                write!(
                    f,
                    "a class name of {bytes} bytes; {MAX_NAME_BYTES} are allowed"
                )
            }
            Self::Smooth(s) => write!(f, "smoothing over {s} bins; 0 to 4096 is allowed"),
            Self::Range { channel } => {
                write!(f, "channel {channel}: its range is too wide or too narrow")
            }
            Self::Model(e) => write!(f, "{e}"),
        }
    }
}

impl core::error::Error for TrainError {}

impl From<ModelError> for TrainError {
    fn from(e: ModelError) -> Self {
        Self::Model(e)
    }
}
