//! A share and how sure it is.

/// A share with its 95 % interval by Wilson. Decisions of one trial are not independent:
/// where there are many a trial, the truth is wider.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// The share found; not a number of nothing.
    pub share: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Of how many.
    pub count: usize,
}

impl Interval {
    /// Of so many of so many.
    pub fn of(part: usize, count: usize) -> Self {
        Self::of_share(part as f64 / count as f64, count)
    }

    /// Of a share that counts as so many independent observations.
    pub fn of_share(share: f64, count: usize) -> Self {
        // The normal quantile of 97.5 %, squared.
        const Z2: f64 = 3.841_458_820_694_124;
        let n = count as f64;
        if count == 0 {
            let (low, high) = (0.0, 1.0);
            return Self {
                share,
                low,
                high,
                count,
            };
        }
        let middle = (share + Z2 / (2.0 * n)) / (1.0 + Z2 / n);
        let spread = share * (1.0 - share) * Z2 / n + Z2 * Z2 / (4.0 * n * n);
        let half = spread.sqrt() / (1.0 + Z2 / n);
        Self {
            share,
            // Exact where all or none are: rounding must not leave the share outside.
            low: (middle - half).max(0.0).min(share),
            high: (middle + half).min(1.0).max(share),
            count,
        }
    }
}
