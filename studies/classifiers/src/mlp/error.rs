//! What can be wrong with a network: its file, its shape or its numbers.

use core::fmt;

use super::limits::{MAX_HIDDEN, MAX_INPUTS, MAX_OUTPUTS, MAX_WEIGHT, MLP_VERSION};

/// Why a network is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum MlpError {
    /// The number of inputs is none, or above [`MAX_INPUTS`].
    Inputs(usize),
    /// The number of hidden units is none, or above [`MAX_HIDDEN`].
    Hidden(usize),
    /// The number of outputs is below 2 or above [`MAX_OUTPUTS`].
    Outputs(usize),
    /// A slice is not as long as the shape asks.
    Length {
        /// By the shape.
        expected: usize,
        /// In the slice.
        found: usize,
    },
    /// A weight or bias is not finite, or larger than [`MAX_WEIGHT`]; in fixed
    /// point, the weights of a unit together could overflow its sum.
    Weight,
    /// The scale of an input is not finite.
    Scale {
        /// The input, from zero.
        input: usize,
    },
    /// In fixed point an input's scale cannot be held: its offset does not fit
    /// an i32, or its standard deviation is below 2⁻⁵ or above 2³⁰ units.
    FixedScale {
        /// The input, from zero.
        input: usize,
    },
    /// The file does not begin with the magic of a network.
    BadMagic,
    /// Written by another version of the format.
    UnknownVersion(u16),
    /// The file holds a network of another shape.
    Shape {
        /// Inputs in the file.
        inputs: usize,
        /// Hidden units in the file.
        hidden: usize,
        /// Outputs in the file.
        outputs: usize,
    },
    /// The checksum does not match: the file is damaged.
    Checksum,
    /// The bytes do not start on a four-byte boundary: see
    /// [`tactile::include_model`].
    Misaligned,
}

impl fmt::Display for MlpError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Inputs(n) => write!(f, "{n} inputs; 1 to {MAX_INPUTS} are allowed"),
            Self::Hidden(n) => write!(f, "{n} hidden units; 1 to {MAX_HIDDEN} are allowed"),
            Self::Outputs(n) => write!(f, "{n} outputs; 2 to {MAX_OUTPUTS} are allowed"),
            Self::Length { expected, found } => {
                write!(f, "{found} numbers or bytes; {expected} are needed")
            }
            Self::Weight => write!(
                f,
                "a weight is not finite or above {MAX_WEIGHT}, or does not fit"
            ),
            Self::Scale { input } => write!(f, "the scale of input {input} is not finite"),
            Self::FixedScale { input } => {
                write!(f, "the scale of input {input} does not fit fixed point")
            }
            Self::BadMagic => f.write_str("not a network: it does not begin with WMLP"),
            Self::UnknownVersion(found) => write!(
                f,
                "network format version {found}; version {MLP_VERSION} is understood"
            ),
            Self::Shape {
                inputs,
                hidden,
                outputs,
            } => write!(
                f,
                "the network is one of {inputs}-{hidden}-{outputs} units, not what is asked for"
            ),
            Self::Checksum => f.write_str("the network is damaged: its CRC-32 does not match"),
            Self::Misaligned => f.write_str("the network does not start on a four-byte boundary"),
        }
    }
}

impl core::error::Error for MlpError {}
