//! What a sensor says while its whisker rests in free air.

use crate::sample::Sample;

/// The code of no deflection.
pub(crate) const MIDDLE: f64 = 8192.0;
/// Codes from there to the end of the range.
pub(crate) const HALF_RANGE: f64 = 8191.0;

/// Codes nearer to an end of the range are at it.
const NEAR_END: u16 = 64;

pub(crate) fn is_at_end(code: u16) -> bool {
    !(NEAR_END..=16_383 - NEAR_END).contains(&code)
}

/// One axis of a sensor at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Channel {
    pub(crate) mean: f64,
    /// Standard deviation of a sample, codes.
    pub(crate) sd: f64,
    /// How far the mean of the last quarter is from that of the first, codes.
    pub(crate) drift: f64,
    pub(crate) span: [u16; 2],
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Zero {
    pub(crate) channels: [Channel; 2],
    pub(crate) counted: usize,
    pub(crate) invalid: usize,
}

impl Channel {
    fn of(codes: &[u16]) -> Option<Self> {
        let mean = |codes: &[u16]| {
            codes.iter().copied().map(f64::from).sum::<f64>() / codes.len().max(1) as f64
        };
        let middle = mean(codes);
        let squares = codes.iter().map(|code| (f64::from(*code) - middle).powi(2));
        let variance = squares.sum::<f64>() / codes.len().saturating_sub(1).max(1) as f64;
        let quarter = codes.len().div_ceil(4);
        let last = codes.get(codes.len().checked_sub(quarter)?..)?;
        Some(Self {
            mean: middle,
            sd: variance.sqrt(),
            drift: mean(last) - mean(codes.get(..quarter)?),
            span: [*codes.iter().min()?, *codes.iter().max()?],
        })
    }

    pub(crate) fn offset(&self) -> f64 {
        (self.mean - MIDDLE) / HALF_RANGE
    }
}

impl Zero {
    /// Of samples at rest; none if no reading counts.
    pub(crate) fn of(samples: &[Sample]) -> Option<Self> {
        let valid = || samples.iter().filter(|sample| sample.is_valid());
        let channel = |axis: usize| {
            let codes: Vec<u16> = valid().map(|sample| sample.codes[axis]).collect();
            Channel::of(&codes)
        };
        let counted = valid().count();
        Some(Self {
            channels: [channel(0)?, channel(1)?],
            counted,
            invalid: samples.len() - counted,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Channel;

    #[test]
    fn a_channel_has_the_moments_of_its_codes() {
        // 100 to 107, twice; the last quarter is 4 above the first.
        let codes: Vec<u16> = (100..108).flat_map(|code| [code, code]).collect();
        let found = Channel::of(&codes).unwrap();
        assert_eq!((found.mean, found.span), (103.5, [100, 107]));
        // Σ(x − 103.5)² = 2 · 42, of 16 samples.
        assert!((found.sd - (84.0_f64 / 15.0).sqrt()).abs() < 1e-12);
        assert_eq!(found.drift, 106.5 - 100.5);
        assert_eq!(Channel::of(&[]), None);
    }
}
