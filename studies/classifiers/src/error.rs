//! What can be wrong with the data, the settings or the numbers of a classifier.

use crate::limits::{MAX_HIDDEN, MAX_INPUTS, MAX_OUTPUTS, MAX_POINTS, MAX_WEIGHT};

/// Why a classifier cannot be made, trained or asked.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The number of channels, or of vibrissae, is zero.
    #[error("no channels")]
    Channels,
    /// The window is zero samples, or its samples times channels above 2²⁴.
    #[error("a window of {0} samples")]
    Window(usize),
    /// A class of 65536 or more.
    #[error("class {0}; below 65536 is allowed")]
    Class(usize),
    /// A number that is infinite or not a number.
    #[error("sample {sample}, channel {channel}: not a finite number")]
    NotFinite {
        /// The sample or row, from zero.
        sample: usize,
        /// Its channel or input, from zero.
        channel: usize,
    },
    /// A segment that is shorter than the window.
    #[error("a segment of {found} samples; {needed} are needed")]
    Short {
        /// Samples in it.
        found: usize,
        /// Samples needed.
        needed: usize,
    },
    /// A segment whose values are no multiple of the channels.
    #[error("a segment of {values} values for {channels} channels")]
    Ragged {
        /// Values in it.
        values: usize,
        /// Channels.
        channels: usize,
    },
    /// A slice, a row or the bins of a bank are not as many as they must be.
    #[error("{found} numbers; {expected} are needed")]
    Length {
        /// By the shape or the bank.
        expected: usize,
        /// In what was given.
        found: usize,
    },
    /// Nothing to train on.
    #[error("there are no samples")]
    NoSamples,
    /// All samples are of one class.
    #[error("all samples are of one class; two are needed")]
    OneClass,
    /// A class below the largest has no segment.
    #[error("class {class} has no segment")]
    Empty {
        /// The class, from zero.
        class: usize,
    },
    /// A class without a name.
    #[error("a class has an empty name")]
    NameEmpty,
    /// The values of a channel span too much or too little to scale.
    #[error("a channel's range is too wide or too narrow")]
    Range,
    /// The points of a spectrum are not 1 to 2²⁴.
    #[error("{0} points; 1 to {MAX_POINTS} are allowed")]
    Points(u32),
    /// No bins, a step of zero, or a bin above half the points.
    #[error("no bins, or one above half the points")]
    Bins,
    /// The block is empty or longer than the points.
    #[error("a block of {block} samples; 1 to the {points} points are allowed")]
    Block {
        /// Samples in the block.
        block: usize,
        /// Points of the transform.
        points: u32,
    },
    /// The words of a table of templates are not a whole number of samples, at
    /// least one.
    #[error("a table of {words} words, for samples of {a_sample} words each")]
    Table {
        /// Words found.
        words: usize,
        /// Words a sample.
        a_sample: usize,
    },
    /// A setting of the features is not positive and finite.
    #[error("a setting is not positive and finite")]
    Setting,
    /// A feature that there is not, or none chosen.
    #[error("feature {0}: there is none, or none is chosen")]
    Feature(usize),
    /// The degree is not 1 to 8, or it gives more than 4096 terms.
    #[error("degree {0}; 1 to 8 and at most 4096 terms are allowed")]
    Degree(u8),
    /// The least squares have no solution.
    #[error("the least squares have no solution")]
    Singular,
    /// The number of a network's inputs is none, or above [`MAX_INPUTS`].
    #[error("{0} inputs; 1 to {MAX_INPUTS} are allowed")]
    Inputs(usize),
    /// The number of hidden units is none, or above [`MAX_HIDDEN`].
    #[error("{0} hidden units; 1 to {MAX_HIDDEN} are allowed")]
    Hidden(usize),
    /// The number of outputs is below 2 or above [`MAX_OUTPUTS`].
    #[error("{0} classes; 2 to {MAX_OUTPUTS} are allowed")]
    Outputs(usize),
    /// A weight or bias is not finite, or larger than [`MAX_WEIGHT`].
    #[error("a weight is not finite or above {MAX_WEIGHT}")]
    Weight,
    /// Offset or gain of an input is not finite: in training it varies, but by
    /// too little.
    #[error("input {input} varies too little to be scaled")]
    Scale {
        /// The input, from zero.
        input: usize,
    },
    /// The penalty is not between 0 and 1.
    #[error("a penalty of {0}; 0 to 1 is allowed")]
    Decay(f64),
    /// The part held out is not between 0 and 0.5.
    #[error("{0} of the samples held out; 0 to 0.5 is allowed")]
    HeldOut(f64),
    /// The hit rate asked for is not at least 0 and below 1.
    #[error("a hit rate of {0}; from 0 to below 1 can be asked for")]
    Reliable(f64),
    /// No start is allowed.
    #[error("no start is allowed; one is needed")]
    NoAttempts,
    /// No start told every class well enough.
    #[error("{attempts} starts, and none told every class well enough")]
    NotReliable {
        /// Starts made.
        attempts: u32,
    },
}
