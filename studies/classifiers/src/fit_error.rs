//! What can be wrong with the segments that a classifier is trained on.

use core::fmt;

use crate::spectrum::SpectrumError;

/// Why a template, spectrum or regression cannot be trained.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum FitError {
    /// The number of channels is zero.
    Channels,
    /// The window is zero samples, or its samples times channels above 2²⁴.
    Window(usize),
    /// A class of 65536 or more.
    Class(usize),
    /// A sample that is infinite or not a number.
    NotFinite {
        /// The sample, from zero.
        sample: usize,
        /// Its channel, from zero.
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
    /// No segment at all.
    NoSegments,
    /// A class below the largest has no segment.
    Empty {
        /// The class, from zero.
        class: usize,
    },
    /// The values of a channel span too much or too little to scale.
    Range,
    /// The bins of a spectrum are unusable.
    Spectrum(SpectrumError),
    /// A setting of the features is not positive and finite.
    Setting,
    /// A feature that there is not, or none chosen.
    Feature(usize),
    /// The degree is not 1 to 8, or it gives more than 4096 terms.
    Degree(u8),
    /// The least squares have no solution.
    Singular,
}

impl fmt::Display for FitError {
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
            Self::NoSegments => f.write_str("there are no segments"),
            Self::Empty { class } => write!(f, "class {class} has no segment"),
            Self::Range => f.write_str("a channel's range is too wide or too narrow"),
            Self::Spectrum(e) => write!(f, "{e}"),
            Self::Setting => f.write_str("a setting is not positive and finite"),
            Self::Feature(n) => write!(f, "feature {n}: there is none, or none is chosen"),
            Self::Degree(n) => write!(f, "degree {n}; 1 to 8 and at most 4096 terms are allowed"),
            Self::Singular => f.write_str("the least squares have no solution"),
        }
    }
}

impl core::error::Error for FitError {}

impl From<SpectrumError> for FitError {
    fn from(e: SpectrumError) -> Self {
        Self::Spectrum(e)
    }
}
