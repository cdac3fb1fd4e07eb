//! What a whisker is made to do while it is calibrated, gentle things first.

use host_sim::Error;

use super::listening::Listening;
use crate::sample::Sample;

pub(crate) const REST_DEG: f64 = 50.0;
/// The small push, degrees, and by how much it must move the whisker.
const PUSH_DEG: f64 = 3.0;
const MOVED_DEG: f64 = 1.0;
/// How fast the whisker is led through its range, degrees/s, and how often a setpoint is sent, s.
const LED_DEG_S: f64 = 100.0;
const LED_EACH_S: f64 = 0.02;
/// A whisker that is so far behind for so long has met something.
const BEHIND_DEG: f64 = 6.0;
const BEHIND_S: f64 = 0.1;
const SETTLES_S: f64 = 0.3;
/// Steps of the setpoint from rest, degrees, and how long each lasts, s. None is as far as what
/// counts as not following.
const STEPS_DEG: [f64; 9] = [30.0, 0.0, 20.0, 5.0, 40.0, 12.0, 35.0, 18.0, 0.0];
const STEP_S: f64 = 0.4;
/// The end of a step, in which the whisker rests, s.
const SETTLED_S: f64 = 0.05;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Push {
    /// With the duty, so far, degrees.
    With(f64),
    /// Against it: encoder or motor is the wrong way round.
    Against(f64),
    Still,
}

pub(crate) fn push(whisker: &mut Listening<'_>) -> Result<Push, Error> {
    whisker.hold(Some(REST_DEG))?;
    let before = whisker.follow(0.3, |_| true)?;
    let Some(from) = before.last().map(|sample| sample.measured_deg) else {
        return Ok(Push::Still);
    };
    whisker.hold(Some(REST_DEG + PUSH_DEG))?;
    let moved = |sample: &Sample| sample.measured_deg - from;
    let mut pushed = 0.0;
    let mut against = false;
    whisker.follow(0.5, |sample| {
        pushed = moved(sample);
        // The duty's direction is the setpoint's: a whisker ahead of it is driven back.
        against = pushed < -MOVED_DEG && sample.duty >= 0.0;
        !against
    })?;
    if against {
        whisker.stop()?;
        return Ok(Push::Against(-pushed));
    }
    whisker.hold(Some(REST_DEG))?;
    whisker.follow(0.3, |_| true)?;
    Ok(if pushed > MOVED_DEG {
        Push::With(pushed)
    } else {
        Push::Still
    })
}

/// Where it met something on its way to `to_deg` and back to rest, if it did, degrees.
pub(crate) fn lead(whisker: &mut Listening<'_>, to_deg: f64) -> Result<Option<f64>, Error> {
    let met = led(whisker, [REST_DEG, to_deg])?;
    led(whisker, [met.unwrap_or(to_deg), REST_DEG])?;
    whisker.follow(SETTLES_S, |_| true)?;
    Ok(met)
}

/// Leads it from where it is to another angle; where it stands, if it meets something.
fn led(whisker: &mut Listening<'_>, [from, to]: [f64; 2]) -> Result<Option<f64>, Error> {
    let pieces = (to - from).abs() / (LED_DEG_S * LED_EACH_S);
    let pieces = pieces.ceil().max(1.0);
    // Since when it is behind.
    let mut behind: Option<f64> = None;
    let mut piece = 0.0;
    loop {
        piece = (piece + 1.0_f64).min(pieces);
        whisker.hold(Some(from + (to - from) * piece / pieces))?;
        let samples = whisker.follow(LED_EACH_S, |sample| {
            let is_behind = (sample.setpoint_deg - sample.measured_deg).abs() > BEHIND_DEG;
            behind = is_behind.then(|| behind.unwrap_or(sample.t_s));
            true
        })?;
        let Some(last) = samples.last() else {
            return Ok(None);
        };
        match behind {
            Some(since) if last.t_s - since >= BEHIND_S => return Ok(Some(last.measured_deg)),
            None if piece >= pieces => return Ok(None),
            // It may still catch up, or is on its way.
            _ => {}
        }
    }
}

/// How far from its setpoint the whisker came to rest at most, degrees, besides.
pub(crate) fn steps(
    whisker: &mut Listening<'_>,
    [low, high]: [f64; 2],
) -> Result<(Vec<Sample>, f64), Error> {
    let (mut stepped, mut most_deg) = (Vec::new(), 0.0_f64);
    for step in STEPS_DEG {
        whisker.hold(Some((REST_DEG + step).clamp(low, high)))?;
        let samples = whisker.follow(STEP_S, |_| true)?;
        let settled = (SETTLED_S / whisker.tick_s()).round() as usize;
        let at_rest = samples.get(samples.len().saturating_sub(settled)..);
        let left = at_rest.unwrap_or_default().iter();
        let left = left.map(|sample| sample.setpoint_deg - sample.measured_deg);
        let left_deg = left.sum::<f64>() / settled.max(1) as f64;
        most_deg = most_deg.max(left_deg.abs());
        stepped.extend(samples);
    }
    Ok((stepped, most_deg))
}
