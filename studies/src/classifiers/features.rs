//! Five numbers that say something of a contact (POSE eq. 3–7).
//!
//! | feature | | says something of |
//! |---|---|---|
//! | f1 = max M(t) | peak deflection | speed |
//! | f2 = f1 / t(f1) | slope to the peak, a second | angle |
//! | f3 = arg max \|X\| | modulation centroid, Hz | texture |
//! | f4 = max \|X\| | its magnitude | texture |
//! | f5 = Σ \|X\| | total magnitude | texture |
//!
//! M(t) is the deflection. The time of the peak counts from contact: from the sample before the
//! deflection first reaches `onset` (from the start if it never does), so that it is at least one
//! sample. X is the discrete Fourier transform of M over the block, from 6 Hz to 1 kHz.

use super::spectrum::{Bins, MAGNITUDE, Spectrum};
use anyhow::{Result, ensure};

/// Places among the five.
pub(crate) const PEAK: usize = 0;
pub(crate) const SLOPE: usize = 1;
pub(crate) const CENTROID: usize = 2;
pub(crate) const CENTROID_MAGNITUDE: usize = 3;
pub(crate) const TOTAL_MAGNITUDE: usize = 4;

pub(crate) struct Extractor {
    /// The deflection from which there is contact.
    onset: f64,
    rate_hz: f64,
    /// Samples in a block: a whole contact.
    block: usize,
    spectrum: Spectrum,
}

impl Extractor {
    pub(crate) fn new(onset: f64, rate_hz: f64, block: usize) -> Result<Self> {
        let bins = Bins::between(block, rate_hz, 6.0, 1000.0)?;
        Ok(Self {
            onset,
            rate_hz,
            block,
            spectrum: Spectrum::new(bins),
        })
    }

    /// f1 to f5 of a block; more samples are left out.
    pub(crate) fn features(&self, segment: &[f64]) -> Result<[f64; 5]> {
        ensure!(segment.len() >= self.block, "a contact without its end");
        let deflection = &segment[..self.block];
        let f1 = deflection.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let first = |is: &dyn Fn(f64) -> bool| deflection.iter().position(|&x| is(x)).unwrap_or(0);
        let (peak, contact) = (first(&|x| x == f1), first(&|x| x >= self.onset));
        // From the sample before contact.
        let time_s = (peak + 1).saturating_sub(contact).max(1) as f64 / self.rate_hz;

        let block = deflection.iter().copied();
        let magnitudes = self.spectrum.of(block, MAGNITUDE)?;
        let f4 = magnitudes.iter().copied().fold(0.0, f64::max);
        let centroid = magnitudes.iter().position(|&x| x == f4).unwrap_or(0);
        let f3 = self.spectrum.bins.frequency(centroid, self.rate_hz);
        Ok([f1, f1 / time_s, f3, f4, magnitudes.iter().sum()])
    }
}

#[cfg(test)]
mod tests {
    use super::Extractor;
    use std::f64::consts::TAU;

    const RATE: f64 = 4000.0;
    const BLOCK: usize = 2000;

    /// A ramp from sample 500 to a peak at sample 699, and a vibration of 80 Hz, which is bin 40.
    fn contact(peak: f64, vibration: f64) -> Vec<f64> {
        let sample = |n| {
            let is_up = (500..700).contains(&n);
            let ramp = if is_up { (n - 499) as f64 / 200.0 } else { 0.0 };
            peak * ramp + vibration * (TAU * 80.0 * n as f64 / RATE).sin()
        };
        (0..BLOCK).map(sample).collect()
    }

    #[test]
    fn features_of_a_ramp_and_a_sine() {
        let extractor = Extractor::new(0.1, RATE, BLOCK).unwrap();
        let [f1, f2, ..] = extractor.features(&contact(3.0, 0.0)).unwrap();
        assert!((f1 - 3.0).abs() < 1e-12);
        // 0.1 is reached by the seventh sample of the ramp, 194 before the end: 3 · 7 / 200.
        assert!((f2 - 3.0 * RATE / 194.0).abs() < 1e-9, "{f2}");

        let [f1, _, f3, f4, f5] = extractor.features(&contact(0.0, 0.05)).unwrap();
        // 50 samples a turn, and none falls on its top.
        let top = 0.05 * (TAU * 12.0 / 50.0).sin();
        assert!((f1 - top).abs() < 1e-12, "{f1}");
        assert!((f3 - 80.0).abs() < 1e-9);
        assert!((f4 - 0.05 * 1000.0).abs() < 1e-9);
        assert!((f5 - f4).abs() < 1e-7, "nothing in the other bins: {f5}");
        assert!(Extractor::new(0.1, 1500.0, BLOCK).is_err());
        assert!(extractor.features(&[0.0]).is_err());
    }
}
