//! The spectrum by a planned FFT, double precision, for training and for PCs.

use std::fmt;
use std::sync::Arc;
use std::vec::Vec;

use realfft::num_complex::Complex;
use realfft::{RealFftPlanner, RealToComplex};

use super::{Bins, Measure};
use crate::error::Error;

/// Some bins of blocks of one length: a plan, which is worth keeping, and its
/// memory.
#[derive(Clone)]
pub struct Spectrum {
    bins: Bins,
    block: usize,
    plan: Arc<dyn RealToComplex<f64>>,
    input: Vec<f64>,
    output: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

impl fmt::Debug for Spectrum {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { bins, block, .. } = self;
        write!(f, "Spectrum {{ bins: {bins:?}, block: {block} }}")
    }
}

impl Spectrum {
    /// Plans the transform of blocks of so many samples.
    ///
    /// # Errors
    ///
    /// Bins or block are out of range.
    pub fn new(bins: Bins, block: usize) -> Result<Self, Error> {
        bins.check_block(block)?;
        let plan = RealFftPlanner::new().plan_fft_forward(bins.points as usize);
        Ok(Self {
            bins,
            block,
            input: plan.make_input_vec(),
            output: plan.make_output_vec(),
            scratch: plan.make_scratch_vec(),
            plan,
        })
    }

    /// Its bins.
    pub fn bins(&self) -> Bins {
        self.bins
    }

    /// Samples in a block.
    pub fn block(&self) -> usize {
        self.block
    }

    /// The bins of a block, in order.
    ///
    /// # Errors
    ///
    /// It has another number of samples.
    pub fn of(
        &mut self,
        block: impl IntoIterator<Item = f64>,
        measure: Measure,
    ) -> Result<Vec<f64>, Error> {
        self.input.fill(0.0);
        let mut block = block.into_iter();
        // The input is asked first, so that no sample beyond it is taken uncounted.
        let taken = self.input.iter_mut().take(self.block).zip(&mut block);
        let found = taken.map(|(input, x)| *input = x).count() + block.count();
        let wrong = Error::Block {
            block: found,
            points: self.bins.points,
        };
        if found != self.block {
            return Err(wrong);
        }
        // The lengths are the plan's own, so it has nothing to refuse.
        self.plan
            .process_with_scratch(&mut self.input, &mut self.output, &mut self.scratch)
            .map_err(|_| wrong)?;
        let bins = self.bins.indices();
        Ok(bins
            .filter_map(|k| self.output.get(k as usize))
            .map(|x| match measure {
                Measure::Magnitude => x.norm(),
                Measure::Power => x.norm_sqr(),
            })
            .collect())
    }
}
