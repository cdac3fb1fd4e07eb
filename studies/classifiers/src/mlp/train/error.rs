//! What can be wrong with the samples or the options of training a network.

use core::fmt;

use crate::mlp::{MAX_OUTPUTS, MlpError};

/// Why no network can be trained.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum NetworkTrainError {
    /// A row with another number of inputs.
    Inputs {
        /// As the trainer was made.
        expected: usize,
        /// In the row.
        found: usize,
    },
    /// A row with an input that no f32 holds.
    NotFinite {
        /// The input, from zero.
        input: usize,
    },
    /// A class without a name.
    NameEmpty,
    /// More classes than a network can have outputs.
    TooManyClasses,
    /// No row at all.
    NoSamples,
    /// All rows are of one class.
    OneClass,
    /// An input varies, but by so little that its scale is no f32.
    Range {
        /// The input, from zero.
        input: usize,
    },
    /// The penalty is not between 0 and 1.
    Decay(f64),
    /// The part held out is not between 0 and 0.5.
    HeldOut(f64),
    /// The hit rate asked for is not at least 0 and below 1.
    Reliable(f64),
    /// No start is allowed.
    NoAttempts,
    /// No start told every class well enough.
    NotReliable {
        /// Starts made.
        attempts: u32,
    },
    /// A shape that no network can have.
    Network(MlpError),
}

impl fmt::Display for NetworkTrainError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Inputs { expected, found } => {
                write!(f, "a row of {found} inputs; {expected} are expected")
            }
            Self::NotFinite { input } => write!(f, "input {input} is not a finite number"),
            Self::NameEmpty => f.write_str("a class has an empty name"),
            Self::TooManyClasses => write!(f, "more than {MAX_OUTPUTS} classes"),
            Self::NoSamples => f.write_str("there are no samples"),
            Self::OneClass => f.write_str("all samples are of one class; two are needed"),
            Self::Range { input } => write!(f, "input {input} varies too little to be scaled"),
            Self::Decay(x) => write!(f, "a penalty of {x}; 0 to 1 is allowed"),
            Self::HeldOut(x) => write!(f, "{x} of the samples held out; 0 to 0.5 is allowed"),
            Self::Reliable(x) => {
                write!(f, "a hit rate of {x}; from 0 to below 1 can be asked for")
            }
            Self::NoAttempts => f.write_str("no start is allowed; one is needed"),
            Self::NotReliable { attempts } => {
                write!(
                    f,
                    "{attempts} starts, and none told every class well enough"
                )
            }
            Self::Network(e) => write!(f, "{e}"),
        }
    }
}

impl core::error::Error for NetworkTrainError {}

impl From<MlpError> for NetworkTrainError {
    fn from(e: MlpError) -> Self {
        Self::Network(e)
    }
}
