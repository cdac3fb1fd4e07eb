//! What can be wrong with the data, the settings or the numbers of a classifier.

use core::fmt;

use crate::limits::{MAX_HIDDEN, MAX_INPUTS, MAX_OUTPUTS, MAX_POINTS, MAX_WEIGHT};

/// Why a classifier cannot be made, trained or asked.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// The number of channels, or of vibrissae, is zero.
    Channels,
    /// The window is zero samples, or its samples times channels above 2²⁴.
    Window(usize),
    /// A class of 65536 or more.
    Class(usize),
    /// A number that is infinite or not a number.
    NotFinite {
        /// The sample or row, from zero.
        sample: usize,
        /// Its channel or input, from zero.
        channel: usize,
    },
    /// A segment that is shorter than the window.
    Short {
        /// Samples in it.
        found: usize,
        /// Samples needed.
        needed: usize,
    },
    /// A segment whose values are no multiple of the channels.
    Ragged {
        /// Values in it.
        values: usize,
        /// Channels.
        channels: usize,
    },
    /// A slice or a row is not as long as it must be.
    Length {
        /// By the shape.
        expected: usize,
        /// In the slice.
        found: usize,
    },
    /// Nothing to train on.
    NoSamples,
    /// All samples are of one class.
    OneClass,
    /// A class below the largest has no segment.
    Empty {
        /// The class, from zero.
        class: usize,
    },
    /// A class without a name.
    NameEmpty,
    /// The values of a channel span too much or too little to scale.
    Range,
    /// The points of a spectrum are not 1 to 2²⁴.
    Points(u32),
    /// No bins, a step of zero, or a bin above half the points.
    Bins,
    /// The block is empty or longer than the points.
    Block {
        /// Samples in the block.
        block: usize,
        /// Points of the transform.
        points: u32,
    },
    /// Another number of bins than the bank has.
    Count {
        /// Asked for.
        bins: usize,
        /// In the bank.
        bank: usize,
    },
    /// The words of a table of templates are not a whole number of samples, at
    /// least one.
    Table {
        /// Words found.
        words: usize,
        /// Words a sample.
        a_sample: usize,
    },
    /// A setting of the features is not positive and finite.
    Setting,
    /// A feature that there is not, or none chosen.
    Feature(usize),
    /// The degree is not 1 to 8, or it gives more than 4096 terms.
    Degree(u8),
    /// The least squares have no solution.
    Singular,
    /// The number of a network's inputs is none, or above [`MAX_INPUTS`].
    Inputs(usize),
    /// The number of hidden units is none, or above [`MAX_HIDDEN`].
    Hidden(usize),
    /// The number of outputs is below 2 or above [`MAX_OUTPUTS`].
    Outputs(usize),
    /// A weight or bias is not finite, or larger than [`MAX_WEIGHT`].
    Weight,
    /// Offset or gain of an input is not finite: in training it varies, but by
    /// too little.
    Scale {
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
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Channels => f.write_str("no channels"),
            Self::Window(n) => write!(f, "a window of {n} samples"),
            Self::Class(n) => write!(f, "class {n}; below 65536 is allowed"),
            Self::NotFinite { sample, channel } => {
                write!(f, "sample {sample}, channel {channel}: not a finite number")
            }
            Self::Short { found, needed } => {
                write!(f, "a segment of {found} samples; {needed} are needed")
            }
            Self::Ragged { values, channels } => {
                write!(f, "a segment of {values} values for {channels} channels")
            }
            Self::Length { expected, found } => {
                write!(f, "{found} numbers; {expected} are needed")
            }
            Self::NoSamples => f.write_str("there are no samples"),
            Self::OneClass => f.write_str("all samples are of one class; two are needed"),
            Self::Empty { class } => write!(f, "class {class} has no segment"),
            Self::NameEmpty => f.write_str("a class has an empty name"),
            Self::Range => f.write_str("a channel's range is too wide or too narrow"),
            Self::Points(n) => write!(f, "{n} points; 1 to {MAX_POINTS} are allowed"),
            Self::Bins => f.write_str("no bins, or one above half the points"),
            Self::Block { block, points } => write!(
                f,
                "a block of {block} samples; 1 to the {points} points are allowed"
            ),
            Self::Count { bins, bank } => write!(f, "{bins} bins in a bank of {bank}"),
            Self::Table { words, a_sample } => write!(
                f,
                "a table of {words} words, for samples of {a_sample} words each"
            ),
            Self::Setting => f.write_str("a setting is not positive and finite"),
            Self::Feature(n) => write!(f, "feature {n}: there is none, or none is chosen"),
            Self::Degree(n) => write!(f, "degree {n}; 1 to 8 and at most 4096 terms are allowed"),
            Self::Singular => f.write_str("the least squares have no solution"),
            Self::Inputs(n) => write!(f, "{n} inputs; 1 to {MAX_INPUTS} are allowed"),
            Self::Hidden(n) => write!(f, "{n} hidden units; 1 to {MAX_HIDDEN} are allowed"),
            Self::Outputs(n) => write!(f, "{n} classes; 2 to {MAX_OUTPUTS} are allowed"),
            Self::Weight => write!(f, "a weight is not finite or above {MAX_WEIGHT}"),
            Self::Scale { input } => write!(f, "input {input} varies too little to be scaled"),
            Self::Decay(x) => write!(f, "a penalty of {x}; 0 to 1 is allowed"),
            Self::HeldOut(x) => write!(f, "{x} of the samples held out; 0 to 0.5 is allowed"),
            Self::Reliable(x) => {
                write!(f, "a hit rate of {x}; from 0 to below 1 can be asked for")
            }
            Self::NoAttempts => f.write_str("no start is allowed; one is needed"),
            Self::NotReliable { attempts } => write!(
                f,
                "{attempts} starts, and none told every class well enough"
            ),
        }
    }
}

impl core::error::Error for Error {}
