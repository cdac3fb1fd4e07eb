//! A polynomial of some features, rounded to the nearest class (POSE section
//! II-D): y = Σ_m c_m Π_f u_f^p_mf, u_f = (x_f − centre_f) · scale_f.
//!
//! Features differ in size by orders of magnitude (volts, hertz), so they are
//! centred and scaled first; powers of them then keep their precision.
//!
//! Fitting: `regression` (feature `train`).

/// One product of powers of F features: 4 + F bytes, rounded up to words.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Term<const F: usize> {
    /// Of each feature.
    pub powers: [u8; F],
    /// What the product is multiplied by.
    pub coefficient: f32,
}

/// A polynomial of F features; its terms are read in place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Polynomial<'a, const F: usize> {
    /// What is subtracted from each feature.
    pub centre: [f32; F],
    /// What it is then multiplied by.
    pub scale: [f32; F],
    /// The terms, in any order.
    pub terms: &'a [Term<F>],
}

impl<const F: usize> Polynomial<'_, F> {
    /// Its value. Rounding of single precision: at most
    /// (terms + 3 · degree) · 6e-8 of Σ |c_m Π u_f^p|.
    pub fn value(&self, features: &[f32; F]) -> f32 {
        let mut scaled = [0.0; F];
        let parts = features.iter().zip(&self.centre).zip(&self.scale);
        for (u, ((x, centre), scale)) in scaled.iter_mut().zip(parts) {
            *u = (x - centre) * scale;
        }
        let product = |term: &Term<F>| {
            let factors = scaled.iter().zip(&term.powers);
            factors.fold(term.coefficient, |product, (u, &power)| {
                (0..power).fold(product, |product, _| product * u)
            })
        };
        self.terms.iter().map(product).sum()
    }
}

/// The class nearest to a value, of classes 0 to `classes` − 1: halves go up,
/// what lies outside to the first or last, not a number to the first.
pub fn nearest(value: f32, classes: usize) -> usize {
    // `as` truncates and saturates; not a number becomes zero.
    ((value + 0.5) as usize).min(classes.saturating_sub(1))
}

#[cfg(test)]
mod tests {
    use super::{Polynomial, Term, nearest};

    #[test]
    fn a_value_worked_by_hand() {
        let terms = [
            Term {
                powers: [0, 0],
                coefficient: 1.0,
            },
            Term {
                powers: [2, 0],
                coefficient: -3.0,
            },
            Term {
                powers: [1, 1],
                coefficient: 0.5,
            },
        ];
        let polynomial = Polynomial {
            centre: [1.0, 10.0],
            scale: [2.0, 0.5],
            terms: &terms,
        };
        // u = [4, −2]: 1 − 3 · 16 + 0.5 · 4 · (−2) = −51.
        assert_eq!(polynomial.value(&[3.0, 6.0]), -51.0);
    }

    #[test]
    fn values_round_to_classes() {
        let cases = [
            (0.49, 0),
            (0.5, 1),
            (2.4, 2),
            (3.6, 3),
            (-7.0, 0),
            (1e30, 3),
            (f32::NAN, 0),
            (f32::NEG_INFINITY, 0),
        ];
        for (value, class) in cases {
            assert_eq!(nearest(value, 4), class, "{value}");
        }
        assert_eq!(nearest(5.0, 0), 0);
    }
}
