//! Moments and ranges of numbers.

/// Mean and standard deviation; zeros of none.
pub(crate) fn moments(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let count = values.clone().count().max(1) as f64;
    let mean = values.clone().sum::<f64>() / count;
    let square = values.map(|x| (x - mean) * (x - mean)).sum::<f64>() / count;
    (mean, square.sqrt())
}

/// The least and the most; infinity and its negative of none.
pub(crate) fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
        (low.min(x), high.max(x))
    })
}
