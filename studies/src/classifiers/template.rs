//! Templates: the class whose mean training vector is nearest, by the sum of squared errors
//! e(T_k) = Σ (I − T_k)². The vector is the signal of all channels over an aligned window
//! (BIOTACT eq. 17, POSE eq. 1) or their spectra one after another (POSE eq. 2, LEP12 section 5.1,
//! whose root-mean-square error is smallest where the sum of squared errors is).

use anyhow::{Result, ensure};
use tactile::Quantiser;

/// The codes of some values, saturated to 16 bits: their squares add up without rounding.
fn coded(quantiser: &Quantiser, values: &[f64]) -> Vec<f64> {
    let codes = values.iter().map(|x| quantiser.code_from_f64(*x));
    let inside = codes.map(|code| code.clamp(quantiser.low, quantiser.high));
    inside.map(f64::from).collect()
}

pub(crate) struct Templates {
    means: Vec<Vec<f64>>,
    /// Of those in codes.
    quantiser: Option<Quantiser>,
}

impl Templates {
    /// The means of vectors by their classes; all have one length. Those of sensor codes can be in
    /// integers of 16 bits, as a board would hold them and signals.
    pub(crate) fn of<'v>(
        vectors: impl IntoIterator<Item = (usize, &'v [f64])>,
        in_codes: bool,
    ) -> Result<Self> {
        let mut sums: Vec<(Vec<f64>, f64)> = Vec::new();
        let mut largest = 0.0_f64;
        for (class, vector) in vectors {
            if class >= sums.len() {
                sums.resize(class + 1, (vec![0.0; vector.len()], 0.0));
            }
            let (sum, number) = &mut sums[class];
            let (found, needed) = (vector.len(), sum.len());
            ensure!(
                found == needed,
                "{found} values, where {needed} were before"
            );
            *number += 1.0;
            sum.iter_mut().zip(vector).for_each(|(sum, x)| *sum += x);
            largest = vector.iter().map(|x| x.abs()).fold(largest, f64::max);
        }
        let fits = |e: &i32| largest * f64::from(1 << e) <= 16384.0;
        let quantiser = in_codes.then(|| Quantiser {
            origin: 0.0,
            exponent: (0..=8).take_while(fits).last().unwrap_or(0),
            low: i32::from(i16::MIN),
            high: i32::from(i16::MAX),
        });
        let mean = |(sum, number): &(Vec<f64>, f64)| {
            let mean: Vec<f64> = sum.iter().map(|x| x / number).collect();
            match &quantiser {
                Some(quantiser) => coded(quantiser, &mean),
                None => mean,
            }
        };
        Ok(Self {
            means: sums.iter().map(mean).collect(),
            quantiser,
        })
    }

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
    use super::Templates;

    #[test]
    fn a_case_worked_by_hand() {
        let known = [
            (0, &[0.0, 2.0, 4.0][..]),
            (0, &[2.0, 2.0, 0.0]),
            (1, &[5.0, 5.0, 5.0]),
        ];
        // Means are 1, 2, 2 and 5, 5, 5: (3 − 1)² + (3 − 2)² + (4 − 2)² = 9 = 4 + 4 + 1.
        for in_codes in [false, true] {
            let templates = Templates::of(known, in_codes).unwrap();
            let named = |signal: [f64; 3]| templates.classify(&signal);
            assert_eq!(named([3.0, 3.0, 4.0]), 0, "the first of equals");
            assert_eq!(named([3.0, 3.0, 5.0]), 1);
        }
        let short = known.into_iter().chain([(0, &[1.0, 1.0][..])]);
        assert!(Templates::of(short, false).is_err());
    }
}
