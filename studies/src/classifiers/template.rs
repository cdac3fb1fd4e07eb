//! Templates: the class whose mean training signal is nearest, by the sum of squared errors over
//! an aligned window (BIOTACT eq. 17, POSE eq. 1):
//! e(T_k) = Σ_t Σ_c (I_c(t) − T_k,c(t))², and the least wins.

use anyhow::Result;
use tactile::Quantiser;

use super::means::{Means, check_segment, least, squared_errors};

#[derive(Debug, Clone)]
pub(crate) struct TemplateTrainer {
    channels: usize,
    window: usize,
    means: Means,
    /// The largest value, whatever its sign.
    largest: f64,
}

impl TemplateTrainer {
    /// For signals of so many channels and, from where they are aligned, so many samples.
    pub(crate) fn new(channels: usize, window: usize) -> Self {
        Self {
            channels,
            window,
            means: Means::default(),
            largest: 0.0,
        }
    }

    /// Adds a signal of a class, sample by sample. What is beyond the window is left out.
    pub(crate) fn add(&mut self, class: usize, segment: &[f64]) -> Result<()> {
        check_segment(segment, self.channels, self.window)?;
        let signal = || segment.iter().copied().take(self.channels * self.window);
        self.largest = signal().map(f64::abs).fold(self.largest, f64::max);
        self.means.add(class, signal());
        Ok(())
    }

    pub(crate) fn train(&self) -> Templates {
        Templates {
            means: self.means.means(),
            largest: self.largest,
        }
    }
}

#[derive(Debug, Clone)]
pub(crate) struct Templates {
    means: Vec<Vec<f64>>,
    largest: f64,
}

impl Templates {
    /// The sum of squared errors of a signal under each class, over the window or over a
    /// shorter signal.
    pub(crate) fn errors(&self, segment: &[f64]) -> Vec<f64> {
        squared_errors(&self.means, segment)
    }

    /// The same for sensor codes, with templates in integers of 16 bits as a board would hold
    /// them.
    pub(crate) fn in_codes(&self) -> CodeTemplates {
        let scales = 0..=8;
        let fits = |e: &i32| self.largest * f64::from(1 << e) <= 16384.0;
        let quantiser = Quantiser {
            origin: 0.0,
            exponent: scales.take_while(fits).last().unwrap_or(0),
            low: i32::from(i16::MIN),
            high: i32::from(i16::MAX),
        };
        let codes = |mean: &Vec<f64>| mean.iter().map(|&x| code(&quantiser, x)).collect();
        CodeTemplates {
            means: self.means.iter().map(codes).collect(),
            quantiser,
        }
    }
}

/// The code of a value, saturated to 16 bits.
fn code(quantiser: &Quantiser, x: f64) -> i64 {
    let code = quantiser.code_from_f64(x);
    i64::from(code.clamp(quantiser.low, quantiser.high))
}

#[derive(Debug, Clone)]
pub(crate) struct CodeTemplates {
    means: Vec<Vec<i64>>,
    quantiser: Quantiser,
}

impl CodeTemplates {
    /// The class whose template is nearest, the first of equals.
    pub(crate) fn classify(&self, segment: &[f64]) -> usize {
        let codes: Vec<i64> = segment.iter().map(|&x| code(&self.quantiser, x)).collect();
        let error = |mean: &Vec<i64>| -> i64 {
            let pairs = codes.iter().zip(mean);
            pairs.map(|(x, t)| (x - t) * (x - t)).sum()
        };
        least(&self.means.iter().map(error).collect::<Vec<_>>())
    }
}

#[cfg(test)]
mod tests {
    use super::TemplateTrainer;

    #[test]
    fn a_case_worked_by_hand() {
        let mut trainer = TemplateTrainer::new(1, 3);
        for (class, signal) in [
            (0, &[0.0, 2.0, 4.0][..]),
            (0, &[2.0, 2.0, 0.0, 99.0]),
            (1, &[5.0, 5.0, 5.0]),
        ] {
            trainer.add(class, signal).unwrap();
        }
        assert!(trainer.add(0, &[1.0, 1.0]).is_err(), "too short");
        let templates = trainer.train();
        // Means are 1, 2, 2 and 5, 5, 5: (3 − 1)² + (3 − 2)² + (4 − 2)² = 9 = 4 + 4 + 1.
        assert_eq!(templates.errors(&[3.0, 3.0, 4.0]), [9.0, 9.0]);
        let named = |signal: &[f64]| templates.in_codes().classify(signal);
        assert_eq!(named(&[3.0, 3.0, 4.0]), 0, "the first of equals");
        assert_eq!(named(&[3.0, 3.0, 5.0]), 1);
        assert_eq!(named(&[3.0, 4.0]), 1, "a shorter signal by what it has");
    }
}
