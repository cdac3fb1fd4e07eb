//! The spectrum of a block of samples, at the frequencies that are needed.
//!
//! # Glossary
//!
//! - **block**: the n samples x(0) … x(n − 1) that a spectrum is taken of.
//! - **points**: the N ≥ n of the discrete Fourier transform; a block is followed by N − n zeros.
//! - **bin**: one frequency, k · rate / N in Hz: X(k) = Σ_j x(j) exp(−2πi j k / N) (POSE eq. 2,
//!   which counts from one).

use anyhow::{Result, bail, ensure};
use std::sync::Arc;

use realfft::num_complex::Complex;
use realfft::{RealFftPlanner, RealToComplex};

/// Which bins of which transform: k = first, first + 1, …, `count` of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Bins {
    pub(crate) points: usize,
    pub(crate) first: usize,
    pub(crate) count: usize,
}

/// What of X(k) is measured: |X(k)| (POSE), or |X(k)|² (LEP12 section 5).
pub(crate) type Measure = fn(&Complex<f64>) -> f64;

pub(crate) const MAGNITUDE: Measure = |x| x.norm();
pub(crate) const POWER: Measure = |x| x.norm_sqr();

impl Bins {
    pub(crate) const fn all(points: usize) -> Self {
        Self {
            points,
            first: 0,
            count: points / 2 + 1,
        }
    }

    /// The bins whose frequencies lie from `low_hz` to `high_hz` (both included, to a millionth
    /// of a bin), at a sample rate of `rate_hz`.
    pub(crate) fn between(points: usize, rate_hz: f64, low_hz: f64, high_hz: f64) -> Result<Self> {
        let k = |hz: f64| hz * points as f64 / rate_hz;
        let first = libm::ceil(k(low_hz) - 1e-6);
        let last = libm::floor(k(high_hz) + 1e-6);
        // What is not a number is in no range.
        if !(first >= 0.0 && last >= first && last <= points as f64 / 2.0) {
            bail!("no bins from {low_hz} to {high_hz} Hz at {rate_hz} samples a second");
        }
        let count = (last - first) as usize + 1;
        Ok(Self {
            points,
            first: first as usize,
            count,
        })
    }

    /// The frequency of a bin, by its place among these, Hz.
    pub(crate) fn frequency(&self, bin: usize, rate_hz: f64) -> f64 {
        (self.first + bin) as f64 * rate_hz / self.points as f64
    }
}

/// Some bins of blocks of one length: a plan, which is worth keeping.
#[derive(Clone)]
pub(crate) struct Spectrum {
    pub(crate) bins: Bins,
    plan: Arc<dyn RealToComplex<f64>>,
}

impl Spectrum {
    pub(crate) fn new(bins: Bins) -> Self {
        let plan = RealFftPlanner::new().plan_fft_forward(bins.points);
        Self { bins, plan }
    }

    pub(crate) fn of(
        &self,
        block: impl Iterator<Item = f64>,
        measure: Measure,
    ) -> Result<Vec<f64>> {
        Ok(self.complex(block)?.iter().map(measure).collect())
    }

    pub(crate) fn complex(&self, block: impl Iterator<Item = f64>) -> Result<Vec<Complex<f64>>> {
        let mut input: Vec<f64> = block.collect();
        let is_short = input.len() <= self.bins.points;
        ensure!(is_short, "a block longer than its transform");
        input.resize(self.bins.points, 0.0);
        let mut output = self.plan.make_output_vec();
        self.plan.process(&mut input, &mut output)?;
        let Bins { first, count, .. } = self.bins;
        Ok(output.into_iter().skip(first).take(count).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::{Bins, MAGNITUDE, POWER, Spectrum};

    #[test]
    fn numpy_gives_the_same() {
        let x = [1.0, -2.0, 3.5, 0.0, 4.0, -1.0, 0.25, 7.0];
        let known = include_str!("../../reference/spectrum.csv").lines();
        let known: Vec<f64> = known.map(|line| line.parse().unwrap()).collect();
        let spectrum = Spectrum::new(Bins::all(12));
        let of = |measure| spectrum.of(x.into_iter(), measure).unwrap();
        let (magnitudes, powers) = (of(MAGNITUDE), of(POWER));
        assert_eq!(magnitudes.len(), known.len());
        for ((found, power), known) in magnitudes.iter().zip(powers).zip(known) {
            assert!((found - known).abs() < 1e-13, "{found} {known}");
            assert!((power - known * known).abs() < 1e-11);
        }
        assert!(spectrum.of([0.0; 13].into_iter(), POWER).is_err());
    }
}
