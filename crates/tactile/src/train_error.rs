//! What can be wrong with training data or its options.

use std::string::String;

use crate::error::ModelError;
use crate::format::{MAX_CLASSES, MAX_NAME_BYTES};
use crate::name::NameError;

/// Why no model can be trained. Classes and channels are counted from zero.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say it")]
pub enum TrainError {
    #[error("class {class} has no sample of channel {channel}; both are counted from 0")]
    Unfelt { channel: usize, class: usize },
    #[error("channel {channel}: a sample is not a finite number")]
    NotFinite { channel: usize },
    #[error("a sample of {found} channels; {expected} are expected")]
    Channels { expected: usize, found: usize },
    #[error("there are no samples")]
    NoSamples,
    #[error("all samples are of one class; two are needed")]
    OneClass,
    #[error("more than {MAX_CLASSES} classes")]
    TooManyClasses,
    #[error("a class has an empty name")]
    NameEmpty,
    #[error("a class name of {bytes} bytes; {MAX_NAME_BYTES} are allowed")]
    NameTooLong { bytes: usize },
    #[error("the class name {name:?} {reason}")]
    Name { name: String, reason: NameError },
    #[error("smoothing over {0} bins; 0 to 4096 is allowed")]
    Smooth(f64),
    /// The range of a channel is too large or too small to scale: wider than
    /// 1e280, or narrower than 1e-280 yet not constant.
    #[error("channel {channel}: its range is too wide or too narrow")]
    Range { channel: usize },
    #[error("{name} {found}; {low} to {high} is allowed")]
    Option {
        name: &'static str,
        found: f64,
        low: f64,
        high: f64,
    },
    #[error("{name}: less than two blocks of samples with contact")]
    TooShort { name: String },
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
