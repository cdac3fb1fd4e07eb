//! Training spectral templates in double precision, and matching them on a PC.
//!
//! See [`crate::spectral_template`] for the rule.

use std::vec::Vec;

use crate::choice::Choice;
use crate::error::Error;
use crate::means::{Means, check_segment, check_window, squared_errors};
use crate::recogniser::{Outcome, Recogniser};
use crate::spectrum::{Bins, Measure, Spectrum};

/// Adds up the spectra of training signals.
#[derive(Debug, Clone)]
pub struct SpectralTrainer {
    channels: usize,
    measure: Measure,
    spectrum: Spectrum,
    means: Means,
}

/// The spectra of a block of several channels, one after another.
fn spectra(
    spectrum: &mut Spectrum,
    measure: Measure,
    channels: usize,
    block: &[f64],
) -> Result<Vec<f64>, Error> {
    let mut all = Vec::with_capacity(channels * spectrum.bins().count);
    for channel in 0..channels {
        let samples = block.iter().skip(channel).step_by(channels).copied();
        all.extend(spectrum.of(samples, measure)?);
    }
    Ok(all)
}

impl SpectralTrainer {
    /// For signals of so many channels, cut into blocks of so many samples.
    ///
    /// # Errors
    ///
    /// No channels, or bins or block are out of range.
    pub fn new(channels: usize, bins: Bins, block: usize, measure: Measure) -> Result<Self, Error> {
        check_window(channels, block)?;
        let spectrum = Spectrum::new(bins, block)?;
        Ok(Self {
            channels,
            measure,
            spectrum,
            means: Means::new(channels * bins.count),
        })
    }

    /// Adds a signal of a class, sample by sample: every whole block of it. A
    /// rest is left out.
    ///
    /// # Errors
    ///
    /// It is shorter than a block, or a number is not finite; it is then not
    /// added.
    pub fn add(&mut self, class: usize, segment: &[f64]) -> Result<(), Error> {
        let block = self.spectrum.block();
        check_segment(segment, self.channels, block)?;
        for block in segment.chunks_exact(block * self.channels) {
            let spectra = spectra(&mut self.spectrum, self.measure, self.channels, block)?;
            self.means.add(class, spectra)?;
        }
        Ok(())
    }

    /// Trains the templates.
    ///
    /// # Errors
    ///
    /// A class has no signal.
    pub fn train(&self) -> Result<SpectralTemplates, Error> {
        Ok(SpectralTemplates {
            channels: self.channels,
            measure: self.measure,
            spectrum: self.spectrum.clone(),
            means: self.means.means()?,
        })
    }
}

/// Spectral templates as trained.
#[derive(Debug, Clone)]
pub struct SpectralTemplates {
    channels: usize,
    measure: Measure,
    spectrum: Spectrum,
    /// Of each class, channel by channel.
    means: Vec<Vec<f64>>,
}

impl SpectralTemplates {
    /// Number of classes K.
    pub fn classes(&self) -> usize {
        self.means.len()
    }

    /// The bins B.
    pub fn bins(&self) -> Bins {
        self.spectrum.bins()
    }

    /// Samples in a block.
    pub fn block(&self) -> usize {
        self.spectrum.block()
    }

    /// The mean spectra of a class, channel by channel.
    pub fn mean(&self, class: usize) -> Option<&[f64]> {
        self.means.get(class).map(Vec::as_slice)
    }

    /// The means for a [`crate::spectral_template::SpectralTemplate`]; `None`
    /// if these have other channels, bins or classes.
    pub fn table<const C: usize, const B: usize, const K: usize>(
        &self,
    ) -> Option<[[[f32; B]; C]; K]> {
        if (self.channels, self.bins().count, self.classes()) != (C, B, K) {
            return None;
        }
        let mut table = [[[0.0; B]; C]; K];
        for (entries, means) in table.iter_mut().zip(&self.means) {
            for (entry, &mean) in entries.as_flattened_mut().iter_mut().zip(means) {
                *entry = mean as f32;
            }
        }
        Some(table)
    }

    /// The sum of squared errors of a block under each class.
    ///
    /// # Errors
    ///
    /// It is no block.
    pub fn errors(&mut self, block: &[f64]) -> Result<Vec<f64>, Error> {
        check_segment(block, self.channels, self.block())?;
        let found = spectra(&mut self.spectrum, self.measure, self.channels, block)?;
        Ok(squared_errors(&self.means, &found))
    }

    /// A recogniser in double precision, by the FFT.
    pub fn recogniser(&self) -> SpectralRecogniser {
        SpectralRecogniser {
            templates: self.clone(),
            open: Vec::with_capacity(self.block() * self.channels),
        }
    }
}

/// Matches spectral templates block by block.
#[derive(Debug, Clone)]
pub struct SpectralRecogniser {
    templates: SpectralTemplates,
    /// The open block.
    open: Vec<f64>,
}

impl Recogniser for SpectralRecogniser {
    fn push(&mut self, sample: &[f64]) -> Option<Outcome> {
        if sample.len() != self.templates.channels {
            return None;
        }
        self.open.extend_from_slice(sample);
        let block = self.templates.block();
        if self.open.len() < block * self.templates.channels {
            return None;
        }
        let errors = self.templates.errors(&self.open);
        self.open.clear();
        // A block with a number that is not finite is like no class.
        let samples = u32::try_from(block).unwrap_or(u32::MAX);
        Choice::least(&errors.ok()?, samples).map(Outcome::from)
    }

    fn finish(&mut self) -> Option<Outcome> {
        self.open.clear();
        None
    }

    fn reset(&mut self) {
        self.open.clear();
    }
}
