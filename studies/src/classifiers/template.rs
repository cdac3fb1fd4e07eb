//! Templates: the class whose mean training vector is nearest, by the sum of squared errors
//! e(T_k) = Σ (I − T_k)². The vector is the signal of all channels over an aligned window
//! (BIOTACT eq. 17, POSE eq. 1) or their spectra one after another (POSE eq. 2, LEP12 section 5.1,
//! whose root-mean-square error is smallest where the sum of squared errors is).

use anyhow::{Result, ensure};
use tactile::Quantiser;

#[derive(Debug, Default)]
pub(crate) struct TemplateTrainer {
    /// Sum and number of each class.
    sums: Vec<(Vec<f64>, u32)>,
    /// The largest value, whatever its sign.
    largest: f64,
}

impl TemplateTrainer {
    /// Adds a vector of a class; all have one length.
    pub(crate) fn add(&mut self, class: usize, vector: &[f64]) -> Result<()> {
        if class >= self.sums.len() {
            self.sums.resize(class + 1, (Vec::new(), 0));
        }
        let (sum, number) = &mut self.sums[class];
        if sum.is_empty() {
            sum.resize(vector.len(), 0.0);
        }
        let (found, needed) = (vector.len(), sum.len());
        ensure!(
            found == needed,
            "{found} values, where {needed} were before"
        );
        *number += 1;
        sum.iter_mut().zip(vector).for_each(|(sum, x)| *sum += x);
        self.largest = vector.iter().map(|x| x.abs()).fold(self.largest, f64::max);
        Ok(())
    }

    pub(crate) fn train(&self) -> Templates {
        let mean =
            |(sum, number): &(Vec<f64>, u32)| sum.iter().map(|x| x / f64::from(*number)).collect();
        Templates {
            means: self.sums.iter().map(mean).collect(),
            quantiser: None,
        }
    }

    /// Of sensor codes: templates and signals in integers of 16 bits as a board would hold them.
    pub(crate) fn train_in_codes(&self) -> Templates {
        let scales = 0..=8;
        let fits = |e: &i32| self.largest * f64::from(1 << e) <= 16384.0;
        let quantiser = Quantiser {
            origin: 0.0,
            exponent: scales.take_while(fits).last().unwrap_or(0),
            low: i32::from(i16::MIN),
            high: i32::from(i16::MAX),
        };
        let Templates { means, .. } = self.train();
        Templates {
            means: means.iter().map(|mean| coded(&quantiser, mean)).collect(),
            quantiser: Some(quantiser),
        }
    }
}

/// The codes of some values, saturated to 16 bits: their squares add up without rounding.
fn coded(quantiser: &Quantiser, values: &[f64]) -> Vec<f64> {
    let code = |x: &f64| quantiser.code_from_f64(*x);
    let codes = values.iter().map(code);
    codes
        .map(|code| f64::from(code.clamp(quantiser.low, quantiser.high)))
        .collect()
}

pub(crate) struct Templates {
    means: Vec<Vec<f64>>,
    /// Of those in codes.
    quantiser: Option<Quantiser>,
}

impl Templates {
    /// The class whose template is nearest, the first of equals.
    pub(crate) fn classify(&self, vector: &[f64]) -> usize {
        match &self.quantiser {
            Some(quantiser) => self.nearest(&coded(quantiser, vector)),
            None => self.nearest(vector),
        }
    }

    fn nearest(&self, vector: &[f64]) -> usize {
        let error = |mean: &Vec<f64>| -> f64 {
            let pairs = vector.iter().zip(mean);
            pairs.map(|(x, t)| (x - t) * (x - t)).sum()
        };
        let errors: Vec<f64> = self.means.iter().map(error).collect();
        let places = 1..errors.len();
        places.fold(0, |best, n| if errors[n] < errors[best] { n } else { best })
    }
}

#[cfg(test)]
mod tests {
    use super::TemplateTrainer;

    #[test]
    fn a_case_worked_by_hand() {
        let mut trainer = TemplateTrainer::default();
        for (class, signal) in [
            (0, [0.0, 2.0, 4.0]),
            (0, [2.0, 2.0, 0.0]),
            (1, [5.0, 5.0, 5.0]),
        ] {
            trainer.add(class, &signal).unwrap();
        }
        assert!(trainer.add(0, &[1.0, 1.0]).is_err(), "too short");
        // Means are 1, 2, 2 and 5, 5, 5: (3 − 1)² + (3 − 2)² + (4 − 2)² = 9 = 4 + 4 + 1.
        for templates in [trainer.train(), trainer.train_in_codes()] {
            let named = |signal: [f64; 3]| templates.classify(&signal);
            assert_eq!(named([3.0, 3.0, 4.0]), 0, "the first of equals");
            assert_eq!(named([3.0, 3.0, 5.0]), 1);
        }
    }
}
