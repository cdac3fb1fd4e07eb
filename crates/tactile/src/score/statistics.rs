//! Mean and spread.

/// Mean and spread of some numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Statistics {
    /// How many, at least one.
    pub count: u64,
    /// Their mean.
    pub mean: f64,
    /// Their standard deviation, by n − 1; zero of one number. POSE's Table I
    /// calls this the standard error.
    pub sd: f64,
    /// Root of their mean square.
    pub rms: f64,
}

impl Statistics {
    /// The standard error of the mean; none of one number.
    pub fn error(&self) -> Option<f64> {
        (self.count > 1).then(|| self.sd / (self.count as f64).sqrt())
    }

    /// Of numbers; `None` if there are none. One pass (Welford), which keeps
    /// its precision however far the mean is from zero.
    pub fn of(numbers: impl IntoIterator<Item = f64>) -> Option<Self> {
        let (mut count, mut mean, mut squares) = (0_u64, 0.0, 0.0);
        for x in numbers {
            count += 1;
            let from = x - mean;
            mean += from / count as f64;
            squares += from * (x - mean);
        }
        if count == 0 {
            return None;
        }
        let n = count as f64;
        Some(Self {
            count,
            mean,
            sd: if count > 1 {
                (squares / (n - 1.0)).sqrt()
            } else {
                0.0
            },
            rms: (squares / n + mean * mean).sqrt(),
        })
    }
}
