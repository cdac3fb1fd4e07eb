//! The spectrum of a block of samples, at the frequencies that are needed.
//!
//! # Glossary
//!
//! - **block**: the n samples x(0) … x(n − 1) that a spectrum is taken of.
//! - **points**: the N ≥ n of the discrete Fourier transform; a block is
//!   followed by N − n zeros.
//! - **bin**: one frequency, k · rate / N in Hz:
//!   X(k) = Σ_j x(j) exp(−2πi j k / N) (POSE eq. 2, which counts from one).
//! - **magnitude**: |X(k)|, in units of the samples; **power**: |X(k)|².
//!
//! # Two ways, one result
//!
//! `Spectrum` (feature `train`) is a planned FFT in double precision. [`Bank`]
//! is for the board: a second-order resonator a bin, stepped with every sample.
//!
//! Why not an FFT on the board: counted on a Cortex-M4F (`docs/measured/instructions.csv`),
//! one of 1024 points takes 48,130 instructions, all in the tick that ends the
//! block, more than half of a tick of 500 µs at 168 MHz. The bank takes about
//! 9.6 a bin in every tick, and in the last another 19 a bin for powers or 41
//! for magnitudes: 460 and 910 for LEP12's 48 bins. In total the FFT is the
//! cheaper one from seven bins on; in the dearest tick, which is what must fit,
//! the bank is up to some nine hundred bins. Without a floating-point unit
//! neither fits: a Cortex-M0 takes 460 instructions a bin and sample.
//! Besides, the papers' blocks (800 samples) are no power of two, so that such
//! an FFT has other bins than those trained on, and it needs the block in
//! memory (4 bytes a sample) where the bank keeps 8 bytes a bin.
//!
//! # Error
//!
//! For blocks to 12000 samples, a bin of the bank is within 3e-6 of the FFT's
//! largest possible magnitude Σ_j |x(j)| (measured: 1.1e-6; see `tests/suite/spectrum.rs`).
//! The mean of the block counts in that bound: subtract the rest position first.

mod bank;
#[cfg(feature = "train")]
mod fft;

pub use bank::{Bank, BankState};
#[cfg(feature = "train")]
pub use fft::Spectrum;

use crate::error::Error;
use crate::limits::MAX_POINTS;

/// Which bins of which transform: k = first, first + step, …, `count` of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bins {
    /// Points N of the transform, 1 to 2²⁴.
    pub points: u32,
    /// The first k.
    pub first: u32,
    /// From one k to the next, at least 1.
    pub step: u32,
    /// How many, at least 1; the last k is at most N / 2.
    pub count: usize,
}

/// What a bin is measured by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// |X(k)| (POSE).
    Magnitude,
    /// |X(k)|² (LEP12 section 5).
    Power,
}

impl Bins {
    /// Every bin of a transform of so many points, from 0 to N / 2.
    pub const fn all(points: u32) -> Self {
        Self {
            points,
            first: 0,
            step: 1,
            count: points as usize / 2 + 1,
        }
    }

    /// The bins whose frequencies lie from `low_hz` to `high_hz` (both
    /// included, to a millionth of a bin), at a sample rate of `rate_hz`.
    ///
    /// # Errors
    ///
    /// There are none, they lie above half the rate, or a number is not
    /// positive and finite (`low_hz` may be zero).
    pub fn between(points: u32, rate_hz: f64, low_hz: f64, high_hz: f64) -> Result<Self, Error> {
        let k = |hz: f64| hz * f64::from(points) / rate_hz;
        let first = libm::ceil(k(low_hz) - 1e-6);
        let last = libm::floor(k(high_hz) + 1e-6);
        // Not a number compares false.
        let fit = rate_hz > 0.0 && first >= 0.0 && last >= first && last <= f64::from(points) / 2.0;
        if !fit {
            return Err(Error::Bins);
        }
        let bins = Self {
            points,
            first: first as u32,
            step: 1,
            count: (last - first) as usize + 1,
        };
        bins.check()?;
        Ok(bins)
    }

    /// Checks the ranges.
    ///
    /// # Errors
    ///
    /// The first that is wrong.
    pub fn check(&self) -> Result<(), Error> {
        if !(1..=MAX_POINTS).contains(&self.points) {
            return Err(Error::Points(self.points));
        }
        let reach = |steps: u128| u128::from(self.first) + steps * u128::from(self.step);
        match (self.count as u128).checked_sub(1).map(reach) {
            Some(last) if self.step > 0 && last <= u128::from(self.points / 2) => Ok(()),
            _ => Err(Error::Bins),
        }
    }

    /// The k of each bin.
    pub fn indices(self) -> impl Iterator<Item = u32> {
        let k = move |n: usize| {
            let reach = u32::try_from(n).unwrap_or(u32::MAX);
            self.first.saturating_add(reach.saturating_mul(self.step))
        };
        (0..self.count).map(k)
    }

    /// The frequency of a bin, by its place among these, Hz.
    pub fn frequency(&self, bin: usize, rate_hz: f64) -> f64 {
        let k = f64::from(self.first) + bin as f64 * f64::from(self.step);
        k * rate_hz / f64::from(self.points)
    }

    fn check_block(&self, block: usize) -> Result<(), Error> {
        self.check()?;
        if block == 0 || block > self.points as usize {
            return Err(Error::Block {
                block,
                points: self.points,
            });
        }
        Ok(())
    }
}
