//! Mean vectors of classes: what both kinds of template are trained as.

use std::vec;
use std::vec::Vec;

use crate::error::Error;

/// Classes that a `u16` can name.
const MAX_CLASSES: usize = 1 << 16;

/// Sums of vectors of one length, a class each.
#[derive(Debug, Clone)]
pub(crate) struct Means {
    length: usize,
    /// Sum and number.
    sums: Vec<(Vec<f64>, u64)>,
}

impl Means {
    pub(crate) fn new(length: usize) -> Self {
        Self {
            length,
            sums: Vec::new(),
        }
    }

    /// Adds a vector of the right length, which the caller makes sure of.
    pub(crate) fn add(
        &mut self,
        class: usize,
        vector: impl IntoIterator<Item = f64>,
    ) -> Result<(), Error> {
        if class >= MAX_CLASSES {
            return Err(Error::Class(class));
        }
        if class >= self.sums.len() {
            self.sums.resize(class + 1, (Vec::new(), 0));
        }
        if let Some((sum, number)) = self.sums.get_mut(class) {
            if sum.is_empty() {
                *sum = vec![0.0; self.length];
            }
            for (sum, x) in sum.iter_mut().zip(vector) {
                *sum += x;
            }
            *number += 1;
        }
        Ok(())
    }

    /// The mean of each class.
    pub(crate) fn means(&self) -> Result<Vec<Vec<f64>>, Error> {
        if self.sums.is_empty() {
            return Err(Error::NoSamples);
        }
        let mean = |(class, (sum, number)): (usize, &(Vec<f64>, u64))| {
            if *number == 0 {
                return Err(Error::Empty { class });
            }
            Ok(sum.iter().map(|x| x / *number as f64).collect())
        };
        self.sums.iter().enumerate().map(mean).collect()
    }
}

/// The sum of squared differences of a vector from each mean, as far as both go.
pub(crate) fn squared_errors(means: &[Vec<f64>], found: &[f64]) -> Vec<f64> {
    let error = |mean: &Vec<f64>| {
        let pairs = found.iter().zip(mean);
        pairs.map(|(x, t)| (x - t) * (x - t)).sum()
    };
    means.iter().map(error).collect()
}

/// Checks that a segment has whole samples, all finite, `needed` of them or more.
pub(crate) fn check_segment(segment: &[f64], channels: usize, needed: usize) -> Result<(), Error> {
    let values = segment.len();
    if channels == 0 || !values.is_multiple_of(channels) {
        return Err(Error::Ragged { values, channels });
    }
    if values / channels < needed {
        return Err(Error::Short {
            found: values / channels,
            needed,
        });
    }
    match segment.iter().position(|x| !x.is_finite()) {
        Some(at) => Err(Error::NotFinite {
            sample: at / channels,
            channel: at % channels,
        }),
        None => Ok(()),
    }
}

/// Checks the shape of a window.
pub(crate) fn check_window(channels: usize, window: usize) -> Result<(), Error> {
    if channels == 0 {
        return Err(Error::Channels);
    }
    match window.checked_mul(channels) {
        Some(1..=0x0100_0000) => Ok(()),
        _ => Err(Error::Window(window)),
    }
}
