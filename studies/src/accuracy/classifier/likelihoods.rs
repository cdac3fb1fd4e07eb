//! Likelihoods in double precision, before any table rounds them.

use tactile::train::Trainer;
use tactile::{Binner, LOG_FLOOR, Quantiser, QuantiserError};

use super::data::CHANNELS;

/// From samples to bins, as the product does it.
pub(super) struct Bins {
    quantisers: [Quantiser; CHANNELS],
    binners: [Binner; CHANNELS],
    count: usize,
}

impl Bins {
    pub(super) fn new(
        quantisers: [Quantiser; CHANNELS],
        count: usize,
    ) -> Result<Self, QuantiserError> {
        let [x, y] = quantisers;
        Ok(Self {
            quantisers,
            binners: [x.binner(count)?, y.binner(count)?],
            count,
        })
    }

    pub(super) fn codes(&self, [x, y]: [f64; CHANNELS]) -> [i32; CHANNELS] {
        let [for_x, for_y] = &self.quantisers;
        [for_x.code_from_f64(x), for_y.code_from_f64(y)]
    }

    pub(super) fn of(&self, [x, y]: [i32; CHANNELS]) -> [usize; CHANNELS] {
        let [for_x, for_y] = &self.binners;
        [for_x.bin(x, self.count), for_y.bin(y, self.count)]
    }
}

/// p + floor of `[bin][channel][class]`: histograms smoothed by a Gaussian cut
/// at four standard deviations, before any rounding. Tables of every width
/// come of it; for the product's width a test compares them with the product's.
pub(super) fn likelihoods(trainer: &Trainer, bins: &Bins) -> Vec<f64> {
    let (classes, smooth) = (trainer.names().len(), trainer.options().smooth);
    let row = CHANNELS * classes;
    let mut counts = vec![0.0; bins.count * row];
    for (class, sample) in trainer.samples() {
        let &[x, y] = sample else { continue };
        for (channel, bin) in bins.of(bins.codes([x, y])).into_iter().enumerate() {
            if let Some(count) = counts.get_mut(bin * row + channel * classes + class) {
                *count += 1.0;
            }
        }
    }
    let reach = (4.0 * smooth) as usize;
    let weight = |distance: usize| {
        if distance == 0 {
            return 1.0;
        }
        (-0.5 * (distance as f64 / smooth).powi(2)).exp()
    };
    let mut smoothed = vec![0.0; counts.len()];
    for (from, counted) in counts.chunks(row).enumerate() {
        let near = from.saturating_sub(reach)..=from + reach;
        for (to, p) in smoothed.chunks_mut(row).enumerate() {
            if near.contains(&to) {
                let weight = weight(from.abs_diff(to));
                for (p, count) in p.iter_mut().zip(counted) {
                    *p += weight * count;
                }
            }
        }
    }
    let mut sums = vec![0.0; row];
    for p in smoothed.chunks(row) {
        for (sum, p) in sums.iter_mut().zip(p) {
            *sum += p;
        }
    }
    let sums = sums.iter().cycle();
    let normalised = smoothed.iter().zip(sums).map(|(p, sum)| p / sum);
    normalised.map(|p| p + LOG_FLOOR).collect()
}
