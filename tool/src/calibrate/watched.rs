//! What a sensor says at rest in free air, and what a module does in a minute: at rest, whisking,
//! and at rest again.

use host_sim::Error;
use wire::Command;

use super::listening::Listening;
use crate::resting::rest;
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

const REST_S: f64 = 3.0;
/// For how long it is watched at least: at rest, whisking, at rest.
pub(crate) const LEAST_S: f64 = 2.0 * REST_S + 1.0;
/// A block whose mean is taken for what is slow, s.
const BLOCK_S: f64 = 0.02;

#[derive(Debug)]
pub(crate) struct Watched {
    pub(crate) zero: [Zero; 2],
    /// Standard deviation of blocks' means at rest over that of white noise: 1 where nothing
    /// slow is in it. x and y.
    pub(crate) slow: [f64; 2],
    /// x and y while it whisks; none: no reading counted.
    pub(crate) air: Option<Zero>,
    /// By how much x and y follow its angle, codes a degree.
    pub(crate) follows: [f64; 2],
    /// Share of readings at an end of their range.
    pub(crate) at_end: f64,
    /// Setpoint against measured while it whisks, root mean square, degrees.
    pub(crate) error_deg: f64,
    pub(crate) invalid: f64,
    pub(crate) lost: u64,
    pub(crate) missed: i64,
    pub(crate) samples: Vec<Sample>,
}

/// A whisker that `has_motor` is armed for it, and stopped again. `seconds` include the rest, and are
/// at least [`LEAST_S`].
pub(crate) fn watch(
    whisker: &mut Listening<'_>,
    seconds: f64,
    has_motor: bool,
) -> Result<Watched, Error> {
    let missed = |whisker: &mut Listening| -> Result<i32, Error> {
        Ok(whisker.module().ask(Command::Status)?.values[1])
    };
    let missed_before = missed(whisker)?;
    let before = at_rest(whisker, REST_S)?;
    if has_motor {
        whisker.arm()?;
        whisker.hold(None)?;
    }
    let whisked = whisker.watch(seconds - 2.0 * REST_S, |_| true)?;
    let after = at_rest(whisker, REST_S)?;
    let missed = i64::from(missed(whisker)?.wrapping_sub(missed_before));

    let fault = "no reading of the sensor counts; whisker log names the fault";
    let none = || Error::Work(fault.to_owned());
    let zero = |samples: &[Sample]| Zero::of(samples).ok_or_else(none);
    let block = (BLOCK_S / whisker.tick_s()).round().max(1.0) as usize;
    let valid = || whisked.iter().filter(|sample| sample.is_valid());
    let squares = whisked
        .iter()
        .map(|s| (s.setpoint_deg - s.measured_deg).powi(2));
    let ends = |sample: &&Sample| sample.codes.iter().any(|code| is_at_end(*code));
    let zeros = [zero(&before)?, zero(&after)?];
    let all = before.len() + whisked.len() + after.len();
    let parts = [&before, &whisked, &after].into_iter().flatten();
    let invalid = parts.filter(|sample| !sample.is_valid()).count();
    Ok(Watched {
        slow: [0, 1].map(|axis| slow(&before, axis, block, &zeros[0].channels[axis])),
        zero: zeros,
        air: Zero::of(&whisked),
        follows: [0, 1].map(|axis| follows(&whisked, axis)),
        at_end: valid().filter(ends).count() as f64 / valid().count().max(1) as f64,
        error_deg: (squares.sum::<f64>() / whisked.len().max(1) as f64).sqrt(),
        invalid: invalid as f64 / all.max(1) as f64,
        lost: whisker.tally.lost,
        missed,
        samples: [before, whisked, after].concat(),
    })
}

/// Listens for so long to a sensor at rest, its motor off.
pub(crate) fn at_rest(whisker: &mut Listening<'_>, seconds: f64) -> Result<Vec<Sample>, Error> {
    rest(whisker.module())?;
    whisker.module().stop()?;
    whisker.go_on()?;
    whisker.watch(0.2, |_| true)?;
    whisker.watch(seconds, |_| true)
}

/// How much more blocks' means scatter than those of white noise.
fn slow(samples: &[Sample], axis: usize, block: usize, channel: &Channel) -> f64 {
    let means = samples.chunks_exact(block).map(|block| {
        let codes = block.iter().map(|sample| f64::from(sample.codes[axis]));
        codes.sum::<f64>() / block.len() as f64
    });
    let squares: Vec<f64> = means.map(|mean| (mean - channel.mean).powi(2)).collect();
    let found = (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt();
    // A code is a step: nothing scatters less than its rounding.
    let white = channel.sd.max(0.3) / (block as f64).sqrt();
    found / white
}

fn follows(samples: &[Sample], axis: usize) -> f64 {
    let valid: Vec<&Sample> = samples.iter().filter(|sample| sample.is_valid()).collect();
    let count = valid.len().max(1) as f64;
    let code = |sample: &Sample| f64::from(sample.codes[axis]);
    let mean = |of: &dyn Fn(&Sample) -> f64| valid.iter().map(|s| of(s)).sum::<f64>() / count;
    let (middle, angle) = (mean(&code), mean(&|sample| sample.measured_deg));
    let joint = mean(&|sample| (code(sample) - middle) * (sample.measured_deg - angle));
    let spread = mean(&|sample| (sample.measured_deg - angle).powi(2));
    if spread > 1.0 { joint / spread } else { 0.0 }
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
