//! What can be wrong with training data or its options.

use std::string::String;

use crate::error::ModelError;
use crate::format::{MAX_CLASSES, MAX_NAME_BYTES};
use crate::name::NameError;

/// Why no model can be trained.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TrainError {
    /// A class has no sample of a channel.
    #[error("class {class} has no sample of channel {channel}; both are counted from 0")]
    Unfelt {
        /// The channel, from zero.
        channel: usize,
        /// The class, from zero.
        class: usize,
    },
    /// A sample that is infinite or not a number.
    #[error("channel {channel}: a sample is not a finite number")]
    NotFinite {
        /// The channel, from zero.
        channel: usize,
    },
    /// A sample with another number of channels.
    #[error("a sample of {found} channels; {expected} are expected")]
    Channels {
        /// As the trainer was made.
        expected: usize,
        /// In the sample.
        found: usize,
    },
    /// No sample at all.
    #[error("there are no samples")]
    NoSamples,
    /// All samples are of one class.
    #[error("all samples are of one class; two are needed")]
    OneClass,
    /// More than 32 classes.
    #[error("more than {MAX_CLASSES} classes")]
    TooManyClasses,
    /// A class without a name.
    #[error("a class has an empty name")]
    NameEmpty,
    /// A class name of more than 255 bytes.
    #[error("a class name of {bytes} bytes; {MAX_NAME_BYTES} are allowed")]
    NameTooLong {
        /// Its length in bytes.
        bytes: usize,
    },
    /// A class name that no class may have (see [`crate::name`]).
    #[error("the class name {name:?} {reason}")]
    Name {
        /// The name.
        name: String,
        /// What is wrong with it.
        reason: NameError,
    },
    /// The smoothing is not between 0 and 4096 bins.
    #[error("smoothing over {0} bins; 0 to 4096 is allowed")]
    Smooth(f64),
    /// The range of a channel is too large or too small to scale: wider than
    /// 1e280, or narrower than 1e-280 yet not constant.
    #[error("channel {channel}: its range is too wide or too narrow")]
    Range {
        /// The channel, from zero.
        channel: usize,
    },
    /// An option of the joint trainer is out of its range.
    #[error("{name} {found}; {low} to {high} is allowed")]
    Option {
        /// Which.
        name: &'static str,
        /// As it was given.
        found: f64,
        /// Least that is allowed.
        low: f64,
        /// Most that is allowed.
        high: f64,
    },
    /// A class that was not felt for two blocks of samples.
    #[error("{name}: less than two blocks of samples with contact")]
    TooShort {
        /// The class.
        name: String,
    },
    /// A setting that no model file can hold.
    #[error(transparent)]
    Model(#[from] ModelError),
}

impl TrainError {
    pub(crate) fn check_name(name: &str) -> Result<(), Self> {
        let bytes = name.len();
        if bytes == 0 {
            return Err(Self::NameEmpty);
        }
        if bytes > MAX_NAME_BYTES {
            return Err(Self::NameTooLong { bytes });
        }
        crate::name::check(name).map_err(|reason| Self::Name {
            name: name.into(),
            reason,
        })
    }
}
