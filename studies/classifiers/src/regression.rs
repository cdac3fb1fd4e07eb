//! Fitting a polynomial of features by linear least squares, in double
//! precision: all products of powers up to a degree (POSE: two; four where
//! three features are combined).

use std::vec;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector, SVD};

use crate::error::Error;
use crate::polynomial::{Polynomial, Term};

/// Highest degree.
const MAX_DEGREE: u8 = 8;
/// Most terms.
const MAX_TERMS: usize = 4096;
/// Singular values below this share of the largest count as zero: products
/// that the data cannot tell apart share their coefficient.
const RANK: f64 = 1e-12;
/// A feature that varies by less than this share of itself is constant.
const SAME: f64 = 1e-12;
/// Steps in which a singular value must be found.
const MAX_STEPS: usize = 10_000;

/// A fitted polynomial.
#[derive(Debug, Clone, PartialEq)]
pub struct Regression {
    centre: Vec<f64>,
    scale: Vec<f64>,
    /// Powers of each feature, and the coefficient.
    terms: Vec<(Vec<u8>, f64)>,
}

/// All exponents of so many features whose sum is at most the degree: by the
/// sum, then with the first feature's power falling.
fn powers(features: usize, degree: u8) -> Option<Vec<Vec<u8>>> {
    let mut all = vec![vec![0; features]];
    for sum in 1..=degree {
        let mut open = vec![(Vec::new(), sum)];
        for feature in 0..features {
            let mut next = Vec::new();
            for (row, left) in &open {
                let least = if feature + 1 == features { *left } else { 0 };
                for power in (least..=*left).rev() {
                    let mut row: Vec<u8> = row.clone();
                    row.push(power);
                    next.push((row, left - power));
                }
            }
            if next.len() + all.len() > MAX_TERMS {
                return None;
            }
            open = next;
        }
        all.extend(open.into_iter().map(|(row, _)| row));
    }
    Some(all)
}

fn product(powers: &[u8], scaled: &[f64]) -> f64 {
    let factors = scaled.iter().zip(powers);
    factors
        .map(|(u, &power)| u.powi(i32::from(power)))
        .product()
}

impl Regression {
    /// Fits to examples: the features of each, and the value to be estimated.
    /// Where the examples do not determine a coefficient, the smallest is taken.
    ///
    /// # Errors
    ///
    /// No examples or features, examples of unlike numbers of features, a
    /// number that is not finite, or a degree out of range.
    pub fn fit(degree: u8, examples: &[(Vec<f64>, f64)]) -> Result<Self, Error> {
        let (first, _) = examples.first().ok_or(Error::NoSamples)?;
        let features = first.len();
        if features == 0 {
            return Err(Error::Feature(0));
        }
        for (sample, (row, target)) in examples.iter().enumerate() {
            if row.len() != features {
                return Err(Error::Feature(row.len()));
            }
            let mut numbers = row.iter().chain([target]);
            if let Some(channel) = numbers.position(|x| !x.is_finite()) {
                return Err(Error::NotFinite { sample, channel });
            }
        }
        if !(1..=MAX_DEGREE).contains(&degree) {
            return Err(Error::Degree(degree));
        }
        let powers = powers(features, degree).ok_or(Error::Degree(degree))?;

        let n = examples.len() as f64;
        let mut centre = vec![0.0; features];
        let mut scale = vec![0.0; features];
        for (feature, (centre, scale)) in centre.iter_mut().zip(&mut scale).enumerate() {
            let column = || examples.iter().filter_map(|(row, _)| row.get(feature));
            *centre = column().map(|x| x / n).sum();
            let square: f64 = column().map(|x| (x - *centre) * (x - *centre) / n).sum();
            let sd = square.sqrt();
            let most = column().fold(0.0_f64, |most, x| most.max(x.abs()));
            // A feature that is the same in all examples, but for the rounding
            // of its mean, says nothing.
            *scale = if sd > SAME * most { sd.recip() } else { 0.0 };
            if ![*centre, sd, *scale].iter().all(|x| x.is_finite()) {
                return Err(Error::Range);
            }
        }
        let mut fitted = Self {
            centre,
            scale,
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
        let svd =
            SVD::try_new(design, true, true, f64::EPSILON, MAX_STEPS).ok_or(Error::Singular)?;
        let most = svd.singular_values.iter().copied().fold(0.0, f64::max);
        let coefficients = svd
            .solve(&targets, RANK * most)
            .map_err(|_| Error::Singular)?;
        if !coefficients.iter().all(|x| x.is_finite()) {
            return Err(Error::Singular);
        }
        fitted.terms = powers
            .into_iter()
            .zip(coefficients.iter().copied())
            .collect();
        Ok(fitted)
    }

    fn scaled(&self, features: &[f64]) -> Vec<f64> {
        let parts = features.iter().zip(&self.centre).zip(&self.scale);
        parts
            .map(|((x, centre), scale)| (x - centre) * scale)
            .collect()
    }

    /// The value estimated from features.
    pub fn value(&self, features: &[f64]) -> f64 {
        let scaled = self.scaled(features);
        let terms = self.terms.iter();
        terms.map(|(powers, c)| c * product(powers, &scaled)).sum()
    }

    /// Powers and coefficients, of centred and scaled features.
    pub fn terms(&self) -> &[(Vec<u8>, f64)] {
        &self.terms
    }

    /// The terms in single precision; `None` for another number of features.
    pub fn single_terms<const F: usize>(&self) -> Option<Vec<Term<F>>> {
        let term = |(powers, c): &(Vec<u8>, f64)| {
            Some(Term {
                powers: powers.as_slice().try_into().ok()?,
                coefficient: *c as f32,
            })
        };
        self.terms.iter().map(term).collect()
    }

    /// The polynomial of a board, with terms of [`Self::single_terms`];
    /// `None` for another number of features.
    pub fn polynomial<'a, const F: usize>(
        &self,
        terms: &'a [Term<F>],
    ) -> Option<Polynomial<'a, F>> {
        let single = |of: &[f64]| {
            let singles: Vec<f32> = of.iter().map(|&x| x as f32).collect();
            singles.try_into().ok()
        };
        Some(Polynomial {
            centre: single(&self.centre)?,
            scale: single(&self.scale)?,
            terms,
        })
    }
}
