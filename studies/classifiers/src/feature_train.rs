//! Training a polynomial of features in double precision, and estimating on a
//! PC. Written from the definitions and not from the streaming code, so that
//! the two can be compared.
//!
//! See [`crate::features`] for the features.

use std::vec::Vec;

use crate::features::{Feature, Features};
use crate::fit_error::FitError;
use crate::means::check_segment;
use crate::recogniser::{Outcome, Recogniser};
use crate::regression::Regression;
use crate::spectrum::{Bank, Bins, Measure, Spectrum, SpectrumError};

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
    pub fn pose(rest: f64, onset: f64, rate_hz: f64, block: usize) -> Result<Self, FitError> {
        let points = u32::try_from(block).map_err(|_| FitError::Window(block))?;
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
    pub fn features<const B: usize>(&self) -> Result<Features<B>, SpectrumError> {
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
    pub fn new(settings: FeatureSettings) -> Result<Self, FitError> {
        let FeatureSettings {
            rest,
            onset,
            rate_hz,
            block,
            bins,
        } = settings;
        if !(rest.is_finite() && onset.is_finite() && rate_hz.is_finite() && rate_hz > 0.0) {
            return Err(FitError::Setting);
        }
        let spectrum = Spectrum::new(bins, block)?;
        Ok(Self { settings, spectrum })
    }

    /// f1 to f5 of a block; more samples are left out.
    ///
    /// # Errors
    ///
    /// It is too short, or a sample is not finite.
    pub fn features(&mut self, segment: &[f64]) -> Result<[f64; 5], FitError> {
        let FeatureSettings {
            rest,
            onset,
            rate_hz,
            block,
            bins,
        } = self.settings;
        check_segment(segment, 1, block)?;
        let deflection: Vec<f64> = segment.iter().take(block).map(|x| x - rest).collect();
        let f1 = deflection.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let peak = deflection.iter().position(|&x| x == f1).unwrap_or(0);
        let contact = deflection.iter().position(|&x| x >= onset).unwrap_or(0);
        // From the sample before contact.
        let time_s = (peak + 1).saturating_sub(contact).max(1) as f64 / rate_hz;

        let magnitudes = self.spectrum.of(&deflection, Measure::Magnitude)?;
        let f4 = magnitudes.iter().copied().fold(0.0, f64::max);
        let centroid = magnitudes.iter().position(|&x| x == f4).unwrap_or(0);
        let f3 = bins.frequency(centroid, rate_hz);
        Ok([f1, f1 / time_s, f3, f4, magnitudes.iter().sum()])
    }
}

/// Collects the features of training signals.
#[derive(Debug, Clone)]
pub struct FeatureTrainer {
    extractor: Extractor,
    chosen: Vec<Feature>,
    degree: u8,
    /// Chosen features and class.
    examples: Vec<(Vec<f64>, f64)>,
    classes: usize,
}

impl FeatureTrainer {
    /// For a polynomial of some features, of a degree from 1 to 8.
    ///
    /// # Errors
    ///
    /// A setting is out of range.
    pub fn new(
        settings: FeatureSettings,
        chosen: &[Feature],
        degree: u8,
    ) -> Result<Self, FitError> {
        Ok(Self {
            extractor: Extractor::new(settings)?,
            chosen: chosen.to_vec(),
            degree,
            examples: Vec::new(),
            classes: 0,
        })
    }

    /// Adds a signal of a class, one channel. Classes are in order of what
    /// they stand for (speeds, angles, roughness).
    ///
    /// # Errors
    ///
    /// It is shorter than a block, or a sample is not finite.
    pub fn add(&mut self, class: usize, segment: &[f64]) -> Result<(), FitError> {
        if class >= 1 << 16 {
            return Err(FitError::Class(class));
        }
        let features = self.extractor.features(segment)?;
        let chosen = self.chosen.iter().map(|f| f.of(&features)).collect();
        self.examples.push((chosen, class as f64));
        self.classes = self.classes.max(class + 1);
        Ok(())
    }

    /// Fits the polynomial.
    ///
    /// # Errors
    ///
    /// There are no signals or no features, or the degree is out of range.
    pub fn train(&self) -> Result<FeatureRegression, FitError> {
        Ok(FeatureRegression {
            extractor: self.extractor.clone(),
            chosen: self.chosen.clone(),
            regression: Regression::fit(self.degree, &self.examples)?,
            classes: self.classes,
        })
    }
}

/// Features and the polynomial of them, as trained.
#[derive(Debug, Clone)]
pub struct FeatureRegression {
    extractor: Extractor,
    chosen: Vec<Feature>,
    regression: Regression,
    classes: usize,
}

impl FeatureRegression {
    /// The polynomial.
    pub fn regression(&self) -> &Regression {
        &self.regression
    }

    /// The features it is of.
    pub fn chosen(&self) -> &[Feature] {
        &self.chosen
    }

    /// How many classes there are.
    pub fn classes(&self) -> usize {
        self.classes
    }

    /// The value estimated from a block, and the class nearest.
    ///
    /// # Errors
    ///
    /// The block is too short, or a sample is not finite.
    pub fn estimate(&mut self, segment: &[f64]) -> Result<(usize, f64), FitError> {
        let features = self.extractor.features(segment)?;
        let chosen: Vec<f64> = self.chosen.iter().map(|f| f.of(&features)).collect();
        let value = self.regression.value(&chosen);
        // Saturates; halves go up.
        let class = ((value + 0.5).floor() as usize).min(self.classes.saturating_sub(1));
        Ok((class, value))
    }

    /// A recogniser in double precision.
    pub fn recogniser(&self) -> FeatureRecogniser {
        FeatureRecogniser {
            trained: self.clone(),
            open: Vec::with_capacity(self.extractor.settings.block),
        }
    }
}

/// Estimates block by block.
#[derive(Debug, Clone)]
pub struct FeatureRecogniser {
    trained: FeatureRegression,
    open: Vec<f64>,
}

impl Recogniser for FeatureRecogniser {
    fn push(&mut self, sample: &[f64]) -> Option<Outcome> {
        let &[x] = sample else { return None };
        self.open.push(x);
        let block = self.trained.extractor.settings.block;
        if self.open.len() < block {
            return None;
        }
        let estimate = self.trained.estimate(&self.open);
        self.open.clear();
        let (class, value) = estimate.ok()?;
        Some(Outcome {
            class,
            samples: u32::try_from(block).unwrap_or(u32::MAX),
            value: Some(value),
        })
    }

    fn finish(&mut self) -> Option<Outcome> {
        self.open.clear();
        None
    }

    fn reset(&mut self) {
        self.open.clear();
    }
}
