//! Moments and ranges of numbers, and what several seeds say together.

/// The least and the most; infinity and its negative of none.
pub(crate) fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
        (low.min(x), high.max(x))
    })
}

/// How sure an interval about a mean is: two-sided quantiles of Student's t of one, two, …
/// degrees of freedom; more have the last.
pub(crate) type Sureness = [f64; 9];

/// 95 and 99 %.
pub(crate) const SURE: Sureness = [
    12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262,
];
pub(crate) const VERY_SURE: Sureness = [
    63.657, 9.925, 5.841, 4.604, 4.032, 3.707, 3.499, 3.355, 3.250,
];

/// What several seeds gave: their mean, and its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Summary {
    pub(crate) mean: f64,
    /// Zero of one seed, whose error is unknown.
    pub(crate) error: f64,
    pub(crate) count: usize,
}

/// The quantile for the mean of so many.
pub(crate) fn quantile(sureness: &Sureness, count: usize) -> f64 {
    sureness[count.saturating_sub(2).min(sureness.len() - 1)]
}

impl Summary {
    pub(crate) fn of(values: &[f64]) -> Self {
        let count = values.len();
        let of = count.max(1) as f64;
        let mean = values.iter().sum::<f64>() / of;
        let squares = values.iter().map(|x| (x - mean) * (x - mean));
        let sd = (squares.sum::<f64>() / of).sqrt();
        // Of the sample, and of its mean.
        let freedom = count.saturating_sub(1).max(1) as f64;
        let error = if count > 1 { sd / freedom.sqrt() } else { 0.0 };
        Self { mean, error, count }
    }

    /// Half of the interval about the mean in which the truth is.
    pub(crate) fn half_interval(&self, sureness: &Sureness) -> f64 {
        quantile(sureness, self.count) * self.error
    }

    /// Whether the mean is beyond its noise (95 %), and which way: 1, −1, or 0.
    pub(crate) fn side(&self) -> i8 {
        let half = self.half_interval(&SURE);
        i8::from(self.mean > half) - i8::from(self.mean < -half)
    }

    /// The mean and its error, with so many digits behind the point.
    pub(crate) fn text(&self, digits: usize, is_signed: bool) -> String {
        // No minus before a zero.
        let unit = 0.1_f64.powi(digits as i32);
        let is_zero = self.mean.abs() < 0.5 * unit;
        let mean = if is_zero { 0.0 } else { self.mean };
        let sign = if is_signed && mean >= 0.0 { "+" } else { "" };
        let error = format!(" ± {:.digits$}", self.error);
        let error = if self.count > 1 { &*error } else { "" };
        format!("{sign}{mean:.digits$}{error}")
    }
}

#[cfg(test)]
mod tests {
    use super::{SURE, Summary};

    #[test]
    fn the_error_is_of_the_mean_and_the_interval_student_s() {
        // Squares about 3: 4 + 1 + 0 + 1 + 4, over 4 and over 5.
        let found = Summary::of(&[1.0, 2.0, 3.0, 4.0, 5.0]);
        assert!((found.mean - 3.0).abs() < 1e-12);
        assert!((found.error - 0.5_f64.sqrt()).abs() < 1e-12, "{found:?}");
        let half = found.half_interval(&SURE);
        assert!((half - 2.776 * 0.5_f64.sqrt()).abs() < 1e-9);
        assert_eq!(found.text(1, true), "+3.0 ± 0.7");
        assert_eq!(Summary::of(&[-0.04]).text(1, false), "0.0");
    }
}
