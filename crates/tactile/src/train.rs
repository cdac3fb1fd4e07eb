//! Training a likelihood model from a recording, in double precision.
//!
//! For each class and channel: a histogram over equal bins of the channel's
//! range in the training data (upper edge included), convolved with a Gaussian
//! that is zero outside the range and cut at four standard deviations,
//! normalised to sum one; [`LOG_FLOOR`] is added before the logarithm
//! (LEP10; LEP12 section 3; BIOTACT section IV: 100 bins, 5 bins).
//!
//! Samples are binned by the quantiser that the module will use, so that
//! training and use agree to the last edge.

pub mod joint;
mod opinion;

use std::borrow::ToOwned;
use std::string::String;
use std::vec;
use std::vec::Vec;

pub use self::opinion::{Expect, Opinion};
use crate::binner::Binner;
use crate::error::ModelError;
use crate::format::{ENTRIES_PER_BIT, ENTRY_MAX, ENTRY_OFFSET_BITS, LOG_FLOOR, MAX_CLASSES};
use crate::layout::{check_bins, check_counts};
use crate::model_buf::{Axis, ModelBuf, ModelParts, TableParts};
use crate::quantiser::Quantiser;
pub use crate::train_error::TrainError;

/// How to train.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Bins a channel, 1 to 4096.
    pub bins: usize,
    /// Standard deviation of the smoothing, bins; 0 (none) to 4096.
    pub smooth: f64,
    /// Samples in a block, 1 to 10000, and at most 65535 over the channels.
    pub block: u32,
}

impl Default for Options {
    /// BIOTACT's 100 bins and 5 bins, LEP12's blocks of 20.
    fn default() -> Self {
        Self {
            bins: 100,
            smooth: 5.0,
            block: 20,
        }
    }
}

/// Collects a recording; keeps it in memory, as bins need the whole range.
#[derive(Debug, Clone)]
pub struct Trainer {
    options: Options,
    channels: usize,
    names: Vec<String>,
    /// Class of each sample.
    classes: Vec<u8>,
    /// Values, the channels of a sample together; not a number: there is none.
    values: Vec<f64>,
}

impl Trainer {
    /// A trainer for samples of so many channels.
    ///
    /// # Errors
    /// An option or the number of channels is out of range.
    pub fn new(channels: usize, options: Options) -> Result<Self, TrainError> {
        check_counts(MAX_CLASSES, channels, options.block)?;
        check_bins(options.bins)?;
        if !(0.0..=4096.0).contains(&options.smooth) {
            return Err(TrainError::Smooth(options.smooth));
        }
        Ok(Self {
            options,
            channels,
            names: Vec::new(),
            classes: Vec::new(),
            values: Vec::new(),
        })
    }

    /// Adds a sample of a class. Classes are numbered as they first appear.
    ///
    /// # Errors
    /// The sample or the name is unusable; it is then not added.
    pub fn add(&mut self, label: &str, sample: &[f64]) -> Result<(), TrainError> {
        if sample.len() != self.channels {
            return Err(TrainError::Channels {
                expected: self.channels,
                found: sample.len(),
            });
        }
        self.add_from(label, 0, sample)
    }

    /// Adds a sample of a class that has values of some channels only, from the `first` on: of
    /// one whisker.
    ///
    /// # Errors
    /// As [`Self::add`].
    pub fn add_from(
        &mut self,
        label: &str,
        first: usize,
        sample: &[f64],
    ) -> Result<(), TrainError> {
        let after = self.channels.checked_sub(first + sample.len());
        let after = after.ok_or(TrainError::Channels {
            expected: self.channels,
            found: first + sample.len(),
        })?;
        if let Some(channel) = sample.iter().position(|x| !x.is_finite()) {
            return Err(TrainError::NotFinite { channel });
        }
        let class = class_of(&mut self.names, label)?;
        // At most 31.
        self.classes.push(class as u8);
        self.values.extend(std::iter::repeat_n(f64::NAN, first));
        self.values.extend_from_slice(sample);
        self.values.extend(std::iter::repeat_n(f64::NAN, after));
        Ok(())
    }

    /// Class names, in order of first appearance.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    fn samples(&self) -> impl Iterator<Item = (usize, &[f64])> {
        self.classes
            .iter()
            .map(|&c| usize::from(c))
            .zip(self.values.chunks_exact(self.channels))
    }

    /// The first channel of which a class has no sample, and that class.
    fn unfelt(&self) -> Option<(usize, usize)> {
        let classes = self.names.len();
        let mut felt = vec![false; self.channels * classes];
        for (class, sample) in self.samples() {
            for (channel, x) in sample.iter().enumerate() {
                felt[channel * classes + class] |= x.is_finite();
            }
        }
        let missing = felt.iter().position(|is_felt| !is_felt)?;
        Some((missing / classes, missing % classes))
    }

    /// Trains the model.
    ///
    /// # Errors
    /// Fewer than two classes, or a range that cannot be scaled.
    pub fn train(&self) -> Result<ModelBuf, TrainError> {
        check_names(&self.names)?;
        if let Some((channel, class)) = self.unfelt() {
            return Err(TrainError::Unfelt { channel, class });
        }
        let quantisers: Vec<Quantiser> = (0..self.channels)
            .map(|channel| self.quantiser(channel).ok_or(TrainError::Range { channel }))
            .collect::<Result<_, _>>()?;
        let Options { bins, block, .. } = self.options;
        let binners: Vec<Binner> = quantisers
            .iter()
            .enumerate()
            .map(|(channel, q)| {
                q.binner(bins)
                    .map_err(|reason| ModelError::Quantiser { channel, reason })
            })
            .collect::<Result<_, _>>()?;

        let classes = self.names.len();
        // Of each channel and class.
        let mut counts = vec![vec![0.0; bins]; self.channels * classes];
        for (class, sample) in self.samples() {
            for (channel, &x) in sample.iter().enumerate().filter(|(_, x)| x.is_finite()) {
                let bin = binners[channel].bin(quantisers[channel].code_from_f64(x), bins - 1);
                counts[channel * classes + class][bin] += 1.0;
            }
        }
        let kernel = gaussian(self.options.smooth);
        let tables: Vec<(Axis, Vec<u16>)> = counts
            .chunks_exact(classes)
            .zip(&quantisers)
            .enumerate()
            .map(|(channel, (counts, q))| {
                let axis = Axis::new(channel, bins, [q.low, q.high]);
                let mut entries = vec![0; bins * classes];
                for (class, histogram) in counts.iter().enumerate() {
                    for (bin, &p) in smoothed(histogram, bins, &kernel).iter().enumerate() {
                        entries[bin * classes + class] = entry(p);
                    }
                }
                (axis, entries)
            })
            .collect();
        let tables: Vec<TableParts<'_>> = tables
            .iter()
            .map(|(axis, entries)| TableParts::of_channel(axis, entries))
            .collect();
        Ok(ModelBuf::new(&ModelParts {
            names: &self.names,
            block,
            channels: &quantisers,
            tables: &tables,
            ..ModelParts::default()
        })?)
    }

    /// The range of a channel. Integers keep their own codes; other data is
    /// scaled so that its range spans above 2¹⁸ up to 2¹⁹ codes, where the
    /// rounding of a code and that of the binner's slope are about equal
    /// (both below 1e-3 of a bin for 100 bins).
    fn quantiser(&self, channel: usize) -> Option<Quantiser> {
        let values = || {
            let values = self.values.iter().skip(channel).step_by(self.channels);
            values.filter(|x| x.is_finite())
        };
        let low = values().copied().fold(f64::INFINITY, f64::min);
        let high = values().copied().fold(f64::NEG_INFINITY, f64::max);
        let bins = self.options.bins;
        let whole = |x: &f64| x.trunc() == *x;
        (values()
            .all(whole)
            .then(|| integer_quantiser(low, high, bins)))
        .flatten()
        .or_else(|| real_quantiser(low, high, bins))
    }
}

/// The number of a class, which is added to the others where it is new.
fn class_of(names: &mut Vec<String>, label: &str) -> Result<usize, TrainError> {
    if let Some(class) = names.iter().position(|name| name == label) {
        return Ok(class);
    }
    TrainError::check_name(label)?;
    if names.len() == MAX_CLASSES {
        return Err(TrainError::TooManyClasses);
    }
    names.push(label.to_owned());
    Ok(names.len() - 1)
}

/// Whether there is something to distinguish.
const fn check_names(names: &[String]) -> Result<(), TrainError> {
    match names {
        [] => Err(TrainError::NoSamples),
        [_] => Err(TrainError::OneClass),
        _ => Ok(()),
    }
}

/// The smallest exponent with more than two codes a bin, if codes then fit.
fn integer_quantiser(low: f64, high: f64, bins: usize) -> Option<Quantiser> {
    (0..=13)
        .map(|exponent| Quantiser {
            origin: 0.0,
            exponent,
            low: (low * f64::from(1 << exponent)) as i32,
            high: (high * f64::from(1 << exponent)) as i32,
        })
        .take_while(|q| {
            let unit = f64::from(1 << q.exponent);
            f64::from(q.low) == low * unit && f64::from(q.high) == high * unit
        })
        .find(|q| q.check(bins).is_ok())
}

fn real_quantiser(low: f64, high: f64, bins: usize) -> Option<Quantiser> {
    let span = high - low;
    let exponent = if span == 0.0 {
        0
    } else if (1e-280..=1e280).contains(&span) {
        // The exponent field of a normal number: 2^e ≤ span < 2^(e + 1).
        let e = (span.to_bits() >> 52) as i32 - 1023;
        let exact_power = span.to_bits().trailing_zeros() >= 52;
        18 - e + i32::from(exact_power)
    } else {
        return None;
    };
    let mut q = Quantiser {
        origin: low,
        exponent,
        low: 0,
        high: 0,
    };
    q.high = q.code_from_f64(high);
    q.check(bins).is_ok().then_some(q)
}

/// exp(−k²/2σ²) for k = 0 to ⌊4σ⌋. No factor: the histogram is normalised after.
fn gaussian(sd: f64) -> Vec<f64> {
    let reach = (4.0 * sd) as usize;
    (0..=reach)
        .map(|k| {
            // No smoothing has a reach of zero; 0/0 must not come of it.
            let z = if k == 0 { 0.0 } else { k as f64 / sd };
            (-0.5 * z * z).exp()
        })
        .collect()
}

/// A histogram of so many columns a row, convolved along both axes with a symmetric kernel, zero
/// outside; sum one.
fn smoothed(histogram: &[f64], columns: usize, kernel: &[f64]) -> Vec<f64> {
    let rows = histogram.len() / columns;
    let along = |from: &[f64], stride: usize, length: usize, place: &dyn Fn(usize) -> usize| {
        let mut to = vec![0.0; from.len()];
        for (cell, &count) in from.iter().enumerate() {
            if count == 0.0 {
                continue;
            }
            let at = place(cell);
            to[cell] += count * kernel[0];
            for (k, &weight) in kernel.iter().enumerate().skip(1) {
                if at >= k {
                    to[cell - k * stride] += count * weight;
                }
                if at + k < length {
                    to[cell + k * stride] += count * weight;
                }
            }
        }
        to
    };
    let within = along(histogram, 1, columns, &|cell| cell % columns);
    let both = along(&within, columns, rows, &|cell| cell / columns);
    let sum: f64 = both.iter().sum();
    // A class may have nothing left when a fold is taken out: nothing is known then.
    let even = 1.0 / both.len() as f64;
    both.iter()
        .map(|x| if sum > 0.0 { x / sum } else { even })
        .collect()
}

fn entry(p: f64) -> u16 {
    let bits = (p + LOG_FLOOR).log2() + f64::from(ENTRY_OFFSET_BITS);
    // `as` saturates; 1 + 1e-6 rounds to the entry of one.
    ((bits * f64::from(ENTRIES_PER_BIT)).round() as u16).min(ENTRY_MAX)
}
