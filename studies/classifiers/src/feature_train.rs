//! The features of whole blocks in double precision, to fit a
//! [`crate::regression::Regression`] to. Written from the definitions and not
//! from the streaming code, so that the two can be compared.
//!
//! See [`crate::features`] for the features.

use std::vec::Vec;

use crate::error::Error;
use crate::features::Features;
use crate::means::check_segment;
use crate::spectrum::{Bank, Bins, Measure, Spectrum};

/// How features are taken; see [`Features`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FeatureSettings {
    /// The sample of a free whisker.
    pub rest: f64,
    /// The deflection from which there is contact.
    pub onset: f64,
    /// Samples a second.
    pub rate_hz: f64,
    /// Samples in a block: a whole trial.
    pub block: usize,
    /// The bins of the spectrum.
    pub bins: Bins,
}

impl FeatureSettings {
    /// POSE's: every bin of the block from 6 Hz to 1 kHz.
    ///
    /// # Errors
    ///
    /// The rate is below 2 kHz, or the block is out of range.
    pub fn pose(rest: f64, onset: f64, rate_hz: f64, block: usize) -> Result<Self, Error> {
        let points = u32::try_from(block).map_err(|_| Error::Window(block))?;
        Ok(Self {
            rest,
            onset,
            rate_hz,
            block,
            bins: Bins::between(points, rate_hz, 6.0, 1000.0)?,
        })
    }

    /// The same for a board.
    ///
    /// # Errors
    ///
    /// Not B bins, or they or the block are out of range.
    pub fn features<const B: usize>(&self) -> Result<Features<B>, Error> {
        let block = u32::try_from(self.block).unwrap_or(u32::MAX);
        let first_hz = self.bins.frequency(0, self.rate_hz);
        Ok(Features {
            rest: self.rest as f32,
            onset: self.onset as f32,
            rate_hz: self.rate_hz as f32,
            bank: Bank::new(&self.bins, block)?,
            first_hz: first_hz as f32,
            step_hz: (self.bins.frequency(1, self.rate_hz) - first_hz) as f32,
        })
    }
}

/// Takes the features of blocks of one channel.
#[derive(Debug, Clone)]
pub struct Extractor {
    settings: FeatureSettings,
    spectrum: Spectrum,
}

impl Extractor {
    /// Checks the settings.
    ///
    /// # Errors
    ///
    /// The first that is wrong.
    pub fn new(settings: FeatureSettings) -> Result<Self, Error> {
        let numbers = [settings.rest, settings.onset, settings.rate_hz];
        if !numbers.iter().all(|x| x.is_finite()) || settings.rate_hz <= 0.0 {
            return Err(Error::Setting);
        }
        let spectrum = Spectrum::new(settings.bins, settings.block)?;
        Ok(Self { settings, spectrum })
    }

    /// f1 to f5 of a block; more samples are left out.
    ///
    /// # Errors
    ///
    /// It is too short, or a sample is not finite.
    pub fn features(&mut self, segment: &[f64]) -> Result<[f64; 5], Error> {
        let settings = &self.settings;
        check_segment(segment, 1, settings.block)?;
        let block = segment.iter().take(settings.block);
        let deflection: Vec<f64> = block.map(|x| x - settings.rest).collect();
        let f1 = deflection.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let peak = deflection.iter().position(|&x| x == f1).unwrap_or(0);
        let contact = deflection
            .iter()
            .position(|&x| x >= settings.onset)
            .unwrap_or(0);
        // From the sample before contact.
        let time_s = (peak + 1).saturating_sub(contact).max(1) as f64 / settings.rate_hz;

        let magnitudes = self.spectrum.of(deflection, Measure::Magnitude)?;
        let f4 = magnitudes.iter().copied().fold(0.0, f64::max);
        let centroid = magnitudes.iter().position(|&x| x == f4).unwrap_or(0);
        let f3 = settings.bins.frequency(centroid, settings.rate_hz);
        Ok([f1, f1 / time_s, f3, f4, magnitudes.iter().sum()])
    }
}
