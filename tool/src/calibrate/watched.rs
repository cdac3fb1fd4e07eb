//! What a module does in a minute: at rest, whisking in free air, and at rest again.

use host_sim::Error;
use wire::Command;

use super::listening::Listening;
use super::rest::{Channel, Zero, is_at_end};
use crate::resting::rest;
use crate::sample::Sample;

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
    let before = at_rest(whisker)?;
    if has_motor {
        whisker.arm()?;
        whisker.hold(None)?;
    }
    let whisked = whisker.watch(seconds - 2.0 * REST_S, |_| true)?;
    let after = at_rest(whisker)?;
    let missed = i64::from(missed(whisker)?.wrapping_sub(missed_before));

    let zero = |samples: &[Sample]| {
        Zero::of(samples).ok_or_else(|| {
            Error::Work("no reading of the sensor counts; whisker log names the fault".to_owned())
        })
    };
    let block = (BLOCK_S / whisker.tick_s()).round().max(1.0) as usize;
    let valid = || whisked.iter().filter(|sample| sample.is_valid());
    let squares = whisked
        .iter()
        .map(|sample| (sample.setpoint_deg - sample.measured_deg).powi(2));
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

fn at_rest(whisker: &mut Listening<'_>) -> Result<Vec<Sample>, Error> {
    rest(whisker.module())?;
    whisker.module().ask(Command::Stop)?;
    whisker.go_on()?;
    whisker.watch(0.2, |_| true)?;
    whisker.watch(REST_S, |_| true)
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
