//! A polynomial of features by linear least squares: all products of powers up to a degree (POSE
//! section II-D: two; four where three features are combined), y = Σ_m c_m Π_f u_f^p_mf.
//!
//! Features differ in size by orders of magnitude (volts, hertz), so they are centred and scaled
//! first, u_f = (x_f − centre_f) · scale_f; powers of them then keep their precision.

use anyhow::{Context, Result, ensure};
use nalgebra::{DMatrix, DVector, SVD};

/// Singular values below this share of the largest count as zero: products
/// that the data cannot tell apart share their coefficient.
const RANK: f64 = 1e-12;
/// A feature that varies by less than this share of itself is constant.
const SAME: f64 = 1e-12;
/// Steps in which a singular value must be found.
const MAX_STEPS: usize = 10_000;

pub(crate) struct Regression {
    /// Centre and scale of each feature.
    scales: Vec<(f64, f64)>,
    /// Powers of each feature, and the coefficient.
    terms: Vec<(Vec<u8>, f64)>,
}

/// All exponents of so many features whose sum is at most the degree: by the sum, then with the
/// first feature's power falling.
fn powers(features: usize, degree: u8) -> Vec<Vec<u8>> {
    let mut all = Vec::new();
    for sum in 0..=degree {
        let mut open = vec![(Vec::new(), sum)];
        for feature in 0..features {
            let is_last = feature + 1 == features;
            let go_on = |(row, left): (Vec<u8>, u8)| {
                let least = if is_last { left } else { 0 };
                let with = move |power| ([&row[..], &[power]].concat(), left - power);
                (least..=left).rev().map(with)
            };
            open = open.into_iter().flat_map(go_on).collect();
        }
        all.extend(open.into_iter().map(|(row, _)| row));
    }
    all
}

fn product(powers: &[u8], scaled: &[f64]) -> f64 {
    let factor = |(u, power): (&f64, &u8)| u.powi(i32::from(*power));
    scaled.iter().zip(powers).map(factor).product()
}

impl Regression {
    /// Where the examples do not determine a coefficient, the smallest is taken.
    pub(crate) fn fit(degree: u8, examples: &[(Vec<f64>, f64)]) -> Result<Self> {
        let (first, _) = examples.first().context("nothing to fit to")?;
        let features = first.len();
        let powers = powers(features, degree);
        let n = examples.len() as f64;
        let scale = |feature: usize| {
            let column = || examples.iter().filter_map(|(row, _)| row.get(feature));
            let centre: f64 = column().map(|x| x / n).sum();
            let square: f64 = column().map(|x| (x - centre) * (x - centre) / n).sum();
            let sd = square.sqrt();
            let most = column().fold(0.0_f64, |most, x| most.max(x.abs()));
            // A feature that is the same in all examples, but for the rounding
            // of its mean, says nothing.
            (centre, if sd > SAME * most { sd.recip() } else { 0.0 })
        };
        let mut fitted = Self {
            scales: (0..features).map(scale).collect(),
            terms: Vec::new(),
        };
        let mut design = DMatrix::zeros(examples.len(), powers.len());
        for (mut row, (example, _)) in design.row_iter_mut().zip(examples) {
            let scaled = fitted.scaled(example);
            for (entry, powers) in row.iter_mut().zip(&powers) {
                *entry = product(powers, &scaled);
            }
        }
        let targets = DVector::from_iterator(examples.len(), examples.iter().map(|(_, y)| *y));
        let singular = "the least squares of a polynomial have no solution";
        let svd = SVD::try_new(design, true, true, f64::EPSILON, MAX_STEPS);
        let svd = svd.context(singular)?;
        let most = svd.singular_values.iter().copied().fold(0.0, f64::max);
        let solved = svd.solve(&targets, RANK * most);
        let coefficients = solved.map_err(anyhow::Error::msg)?;
        ensure!(coefficients.iter().all(|x| x.is_finite()), singular);
        let terms = powers.into_iter().zip(coefficients.iter().copied());
        fitted.terms = terms.collect();
        Ok(fitted)
    }

    fn scaled(&self, features: &[f64]) -> Vec<f64> {
        let part = |(x, (centre, scale)): (&f64, &(f64, f64))| (x - centre) * scale;
        features.iter().zip(&self.scales).map(part).collect()
    }

    pub(crate) fn value(&self, features: &[f64]) -> f64 {
        let scaled = self.scaled(features);
        let terms = self.terms.iter();
        terms.map(|(powers, c)| c * product(powers, &scaled)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::Regression;

    /// Noisy examples, whose best fit NumPy knows: reference/regression.py.
    #[test]
    fn numpy_fits_the_same() {
        for (degree, terms, file) in [
            (2, 10, include_str!("../../reference/regression_2.csv")),
            (4, 35, include_str!("../../reference/regression_4.csv")),
        ] {
            let numbers = |line: &str| line.split(',').map(|x| x.parse().unwrap()).collect();
            let rows: Vec<Vec<f64>> = file.lines().map(numbers).collect();
            let examples: Vec<_> = rows.iter().map(|r| (r[..3].to_vec(), r[3])).collect();
            let fitted = Regression::fit(degree, &examples).unwrap();
            assert_eq!(fitted.terms.len(), terms);
            for row in &rows {
                let found = fitted.value(&row[..3]);
                assert!((found - row[4]).abs() < 1e-8, "{found} {}", row[4]);
                assert!((row[3] - row[4]).abs() > 1e-6, "noise is in the examples");
            }
        }
    }

    #[test]
    fn what_the_examples_do_not_say_is_not_made_up() {
        // The second feature never changes; the third is the first again.
        let examples: Vec<_> = (0..9)
            .map(|n| (vec![f64::from(n), 5.0, f64::from(n)], f64::from(n)))
            .collect();
        let fitted = Regression::fit(2, &examples).unwrap();
        for x in [2.5, 7.0] {
            assert!((fitted.value(&[x, 5.0, x]) - x).abs() < 1e-9);
            assert!((fitted.value(&[x, 99.0, x]) - x).abs() < 1e-9);
        }
        assert!(Regression::fit(2, &[]).is_err());
    }
}
