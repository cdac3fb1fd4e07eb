//! Covariances: symmetric, positive definite, of at most forty numbers.

use std::vec;
use std::vec::Vec;

/// A square matrix, row after row; of a symmetric one only what lies on the diagonal and below.
#[derive(Debug, Clone)]
pub(super) struct Matrix {
    size: usize,
    values: Vec<f64>,
}

impl Matrix {
    pub(super) fn zero(size: usize) -> Self {
        Self {
            size,
            values: vec![0.0; size * size],
        }
    }

    pub(super) fn add_square(&mut self, vector: &[f64], share: f64) {
        let rows = self.values.chunks_exact_mut(self.size);
        for (n, (row, a)) in rows.zip(vector).enumerate() {
            for (value, b) in row.iter_mut().zip(&vector[..=n]) {
                *value += share * a * b;
            }
        }
    }

    pub(super) fn add(&mut self, other: &Self, share: f64) {
        for (value, other) in self.values.iter_mut().zip(&other.values) {
            *value += share * other;
        }
    }

    pub(super) fn raise(&mut self, by: f64) {
        let diagonal = self.values.iter_mut().step_by(self.size + 1);
        diagonal.for_each(|value| *value += by);
    }

    pub(super) fn scale(&mut self, share: f64) {
        self.values.iter_mut().for_each(|value| *value *= share);
    }

    /// What lies off the diagonal times `1 - share`, and the diagonal no less than `least`.
    pub(super) fn shrink(&mut self, share: f64, least: f64) {
        for (row, values) in self.values.chunks_exact_mut(self.size).enumerate() {
            for (column, value) in values.iter_mut().enumerate() {
                *value = if row == column {
                    value.max(least)
                } else {
                    *value * (1.0 - share)
                };
            }
        }
    }

    /// The inverse L of its Cholesky factor: |L v|² is the squared distance of v.
    pub(super) fn whitening(&self) -> Self {
        let n = self.size;
        let at = |values: &[f64], row: usize, column: usize| values[row * n + column];
        let mut factor = vec![0.0; n * n];
        for row in 0..n {
            for column in 0..=row {
                let known: f64 = (0..column)
                    .map(|k| at(&factor, row, k) * at(&factor, column, k))
                    .sum();
                let rest = at(&self.values, row, column) - known;
                factor[row * n + column] = if row == column {
                    // Positive but for rounding.
                    rest.max(1e-12).sqrt()
                } else {
                    rest / at(&factor, column, column)
                };
            }
        }
        let mut inverse = vec![0.0; n * n];
        for column in 0..n {
            for row in column..n {
                let one = f64::from(u8::from(row == column));
                let known: f64 = (column..row)
                    .map(|k| at(&factor, row, k) * at(&inverse, k, column))
                    .sum();
                inverse[row * n + column] = (one - known) / at(&factor, row, row);
            }
        }
        Self {
            size: n,
            values: inverse,
        }
    }

    pub(super) fn triangle(&self) -> impl Iterator<Item = &[f64]> {
        let rows = self.values.chunks_exact(self.size).enumerate();
        rows.map(|(row, values)| &values[..=row])
    }

    /// Of a whitening L: L v.
    pub(super) fn of(&self, vector: &[f64]) -> Vec<f64> {
        let product = |row: &[f64]| row.iter().zip(vector).map(|(a, b)| a * b).sum();
        self.triangle().map(product).collect()
    }

    /// Of a whitening L: Lᵀ L v.
    pub(super) fn twice(&self, vector: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; self.size];
        for (row, share) in self.triangle().zip(self.of(vector)) {
            for (sum, value) in product.iter_mut().zip(row) {
                *sum += share * value;
            }
        }
        product
    }
}

pub(super) fn square(vector: &[f64]) -> f64 {
    vector.iter().map(|value| value * value).sum()
}

/// The mean of vectors of `size` numbers; zeros where there are none.
pub(super) fn mean<'v>(size: usize, vectors: impl Iterator<Item = &'v [f64]>) -> Vec<f64> {
    let (mut sum, mut count) = (vec![0.0; size], 0_u32);
    for vector in vectors {
        count += 1;
        for (sum, value) in sum.iter_mut().zip(vector) {
            *sum += value;
        }
    }
    let count = f64::from(count.max(1));
    for sum in &mut sum {
        *sum /= count;
    }
    sum
}

/// The mean of each group of at least three vectors, and the degrees of freedom of how these differ
/// from it, which is added to `within`.
pub(super) fn pooled<'v>(
    size: usize,
    groups: impl Iterator<Item = Vec<&'v [f64]>>,
    within: &mut Matrix,
) -> (Vec<Vec<f64>>, usize) {
    let (mut centres, mut freedom) = (Vec::new(), 0);
    for of in groups.filter(|of| of.len() >= 3) {
        let centre = mean(size, of.iter().copied());
        for vector in &of {
            within.add_square(&less(vector, &centre), 1.0);
        }
        freedom += of.len() - 1;
        centres.push(centre);
    }
    (centres, freedom)
}

pub(super) fn less(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

/// The value below which a share of all lies, between two of them in proportion; none of none.
pub(super) fn quantile(values: &mut [f64], share: f64) -> Option<f64> {
    values.sort_unstable_by(f64::total_cmp);
    let place = share * values.len().checked_sub(1)? as f64;
    let below = values[place.floor() as usize];
    let above = values[place.ceil() as usize];
    Some(below + (above - below) * place.fract())
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    #[test]
    fn a_whitening_inverts_its_covariance() {
        let mut matrix = Matrix::zero(3);
        for vector in [
            [1.0, 2.0, 0.5],
            [-1.0, 0.3, 2.0],
            [0.2, -1.5, 1.0],
            [2.0, 0.0, 0.0],
        ] {
            matrix.add_square(&vector, 1.0);
        }
        let vector = [0.7, -0.2, 1.1];
        let solved = matrix.whitening().twice(&vector);
        for (row, expected) in vector.into_iter().enumerate() {
            let at = |column: usize| matrix.values[3 * row.max(column) + row.min(column)];
            let found: f64 = (0..3).map(|column| at(column) * solved[column]).sum();
            assert_relative_eq!(found, expected, epsilon = 1e-12);
        }
    }

    #[test]
    fn quantiles_lie_between_values() {
        assert_eq!(quantile(&mut [3.0, 1.0, 2.0], 0.75), Some(2.5));
        assert_eq!(quantile(&mut [4.0], 0.9), Some(4.0));
        assert_eq!(quantile(&mut [], 0.9), None);
    }
}
