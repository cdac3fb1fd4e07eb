//! Mean vectors of classes: what both kinds of template are trained as.

use anyhow::{Result, bail};

#[derive(Debug, Clone, Default)]
pub(crate) struct Means {
    /// Sum and number.
    sums: Vec<(Vec<f64>, u32)>,
}

impl Means {
    pub(crate) fn add(&mut self, class: usize, vector: impl Iterator<Item = f64>) {
        if class >= self.sums.len() {
            self.sums.resize(class + 1, (Vec::new(), 0));
        }
        let (sum, number) = &mut self.sums[class];
        *number += 1;
        if sum.is_empty() {
            sum.extend(vector);
        } else {
            sum.iter_mut().zip(vector).for_each(|(sum, x)| *sum += x);
        }
    }

    pub(crate) fn means(&self) -> Vec<Vec<f64>> {
        let mean =
            |(sum, number): &(Vec<f64>, u32)| sum.iter().map(|x| x / f64::from(*number)).collect();
        self.sums.iter().map(mean).collect()
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

/// The place of the least error, the first of equals.
pub(crate) fn least<T: PartialOrd>(errors: &[T]) -> usize {
    let places = 1..errors.len();
    places.fold(0, |best, n| if errors[n] < errors[best] { n } else { best })
}

/// Refuses a segment that has not whole samples, or fewer than are needed.
pub(crate) fn check_segment(segment: &[f64], channels: usize, needed: usize) -> Result<()> {
    let values = segment.len();
    if needed == 0 || !values.is_multiple_of(channels) || values / channels < needed {
        bail!("a segment of {values} values; {needed} samples of {channels} channels are needed");
    }
    Ok(())
}
