//! Spectral templates: the class whose mean training spectrum is nearest, by the sum of squared
//! errors over the bins that are used (POSE eq. 2, LEP12 section 5.1). LEP12's root-mean-square
//! error is smallest where the sum of squared errors is. Bins of several channels are added up,
//! all weighing the same.

use super::means::{Means, check_segment, squared_errors};
use super::spectrum::{Bins, Measure, Spectrum};
use anyhow::Result;

#[derive(Clone)]
struct Spectra {
    channels: usize,
    block: usize,
    measure: Measure,
    spectrum: Spectrum,
}

impl Spectra {
    fn of(&self, block: &[f64]) -> Result<Vec<f64>> {
        let mut all = Vec::with_capacity(self.channels * self.spectrum.bins.count);
        for channel in 0..self.channels {
            let samples = block.iter().skip(channel).step_by(self.channels).copied();
            all.extend(self.spectrum.of(samples, self.measure)?);
        }
        Ok(all)
    }
}

#[derive(Clone)]
pub(crate) struct SpectralTrainer {
    spectra: Spectra,
    means: Means,
}

impl SpectralTrainer {
    pub(crate) fn new(channels: usize, bins: Bins, block: usize, measure: Measure) -> Self {
        let spectrum = Spectrum::new(bins);
        Self {
            spectra: Spectra {
                channels,
                block,
                measure,
                spectrum,
            },
            means: Means::default(),
        }
    }

    /// Adds a signal of a class, sample by sample: every whole block of it.
    pub(crate) fn add(&mut self, class: usize, segment: &[f64]) -> Result<()> {
        let Spectra {
            channels, block, ..
        } = self.spectra;
        check_segment(segment, channels, block)?;
        for block in segment.chunks_exact(block * channels) {
            self.means.add(class, self.spectra.of(block)?.into_iter());
        }
        Ok(())
    }

    pub(crate) fn train(self) -> SpectralTemplates {
        SpectralTemplates {
            means: self.means.means(),
            spectra: self.spectra,
        }
    }
}

pub(crate) struct SpectralTemplates {
    spectra: Spectra,
    means: Vec<Vec<f64>>,
}

impl SpectralTemplates {
    pub(crate) fn errors(&self, block: &[f64]) -> Result<Vec<f64>> {
        check_segment(block, self.spectra.channels, self.spectra.block)?;
        Ok(squared_errors(&self.means, &self.spectra.of(block)?))
    }
}

#[cfg(test)]
mod tests {
    use super::{Bins, Measure, SpectralTrainer};
    use std::f64::consts::TAU;

    /// Two channels at 2 kHz: a sine of some amplitude in the one, one of 50 Hz in the other.
    fn signal(amplitude: f64, hz: f64, phase: f64, samples: usize) -> Vec<f64> {
        let sample = |n| {
            let turns = n as f64 / 2000.0;
            let x = 7.0 + amplitude * (TAU * hz * turns + phase).sin();
            [x, (TAU * 50.0 * turns + phase).cos()]
        };
        (0..samples).flat_map(sample).collect()
    }

    /// A sine of amplitude A has A n / 2 in its bin, whatever its phase.
    #[test]
    fn errors_are_those_of_sines() {
        // 40 bins of 2.5 Hz, as LEP12's.
        let bins = Bins {
            points: 800,
            first: 1,
            count: 40,
        };
        for (measure, power) in [(Measure::Magnitude, 1), (Measure::Power, 2)] {
            let mut trainer = SpectralTrainer::new(2, bins, 800, measure);
            let classes = [(1.0, 30.0), (2.0, 30.0), (1.0, 75.0)];
            for (class, (amplitude, hz)) in classes.into_iter().enumerate() {
                for phase in [0.3, 1.9] {
                    // Two blocks and a rest.
                    let signal = signal(amplitude, hz, phase, 1700);
                    trainer.add(class, &signal).unwrap();
                }
            }
            let templates = trainer.train();
            let known = |amplitude: f64| (amplitude * 400.0).powi(power);
            let near = (known(1.2) - known(1.0)).powi(2);
            let louder = (known(1.2) - known(2.0)).powi(2);
            let other = known(1.2).powi(2) + known(1.0).powi(2);
            let errors = templates.errors(&signal(1.2, 30.0, 0.9, 800)).unwrap();
            for (found, exact) in errors.iter().zip([near, louder, other]) {
                assert!((found / exact - 1.0).abs() < 1e-9, "{found} {exact}");
            }
            assert!(templates.errors(&[0.0; 6]).is_err());
        }
    }
}
