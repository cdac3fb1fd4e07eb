//! A network on the spectrum of each block, as a recogniser for experiments
//! (LEP12 section 5.2).

use std::vec::Vec;

use super::error::MlpError;
use super::network::Network;
use crate::recogniser::{Outcome, Recogniser};
use crate::spectrum::{Bins, Measure, Spectrum, SpectrumError};

/// The bins of LEP12 section 5.2, one reading of it: the paper has 120 inputs
/// of "the spectrum up to 120 Hz" for two channels at 2 kHz, 800 samples a
/// block, and the Cooley–Tukey transform. Followed by zeros to the next power
/// of two, 1024 points, the bins are 1.95 Hz apart, and 60 a channel reach up to
/// 115 Hz. The transform of 800 points would have 49 a channel.
pub const SPECTRUM_BINS: Bins = Bins {
    points: 1024,
    first: 0,
    step: 1,
    count: 60,
};

/// The spectra of all channels of a block, one after the other: a network's
/// inputs.
#[derive(Debug, Clone)]
pub struct SpectrumInputs {
    spectrum: Spectrum,
    measure: Measure,
    channels: usize,
}

impl SpectrumInputs {
    /// For blocks of `block` samples of so many channels.
    ///
    /// # Errors
    ///
    /// The bins or the block are out of range, or there are no channels.
    pub fn new(
        bins: Bins,
        block: usize,
        channels: usize,
        measure: Measure,
    ) -> Result<Self, SpectrumError> {
        if channels == 0 {
            return Err(SpectrumError::Bins);
        }
        Ok(Self {
            spectrum: Spectrum::new(bins, block)?,
            measure,
            channels,
        })
    }

    /// LEP12's: power, [`SPECTRUM_BINS`], blocks of 800 samples of two channels.
    ///
    /// # Errors
    ///
    /// None.
    pub fn lep12() -> Result<Self, SpectrumError> {
        Self::new(SPECTRUM_BINS, 800, 2, Measure::Power)
    }

    /// Numbers of a row.
    pub fn inputs(&self) -> usize {
        self.spectrum.bins().count * self.channels
    }

    /// Samples of a block.
    pub fn block(&self) -> usize {
        self.spectrum.block()
    }

    /// The row of a block, its samples one after the other: to train on, or
    /// to classify.
    ///
    /// # Errors
    ///
    /// It has another number of samples.
    pub fn row(&mut self, block: &[f64]) -> Result<Vec<f64>, SpectrumError> {
        let mut row = Vec::with_capacity(self.inputs());
        for channel in 0..self.channels {
            let samples = block.iter().skip(channel).step_by(self.channels).copied();
            row.extend(self.spectrum.of_samples(samples, self.measure)?);
        }
        Ok(row)
    }
}

/// Names a class after each block.
#[derive(Debug, Clone)]
pub struct SpectrumRecogniser<'n> {
    inputs: SpectrumInputs,
    network: &'n Network,
    block: Vec<f64>,
}

impl<'n> SpectrumRecogniser<'n> {
    /// Of the inputs that the network was trained on.
    ///
    /// # Errors
    ///
    /// The network has another number of inputs.
    pub fn new(inputs: SpectrumInputs, network: &'n Network) -> Result<Self, MlpError> {
        let (expected, found) = (inputs.inputs(), network.shape().inputs);
        if expected != found {
            return Err(MlpError::Length { expected, found });
        }
        Ok(Self {
            block: Vec::with_capacity(inputs.block() * inputs.channels),
            inputs,
            network,
        })
    }
}

impl Recogniser for SpectrumRecogniser<'_> {
    fn push(&mut self, sample: &[f64]) -> Option<Outcome> {
        if sample.len() != self.inputs.channels {
            return None;
        }
        self.block.extend_from_slice(sample);
        let samples = self.inputs.block();
        if self.block.len() < samples * sample.len() {
            return None;
        }
        let row = self.inputs.row(&self.block);
        self.block.clear();
        let class = self.network.classify(&row.ok()?).ok()?;
        Some(Outcome {
            class,
            samples: samples as u32,
            value: None,
        })
    }

    /// Drops the open block: a spectrum of fewer samples has another scale.
    fn finish(&mut self) -> Option<Outcome> {
        self.reset();
        None
    }

    fn reset(&mut self) {
        self.block.clear();
    }
}
