//! Why hit rates on the simulated floors differ from the paper's, measured.

use super::groups::{Curves, Group};
use crate::experiment::dataset::Dataset;
use crate::experiment::floors::{CHANNELS, Floors, Stream};
use crate::experiment::record::on_other_rigs;
use crate::experiment::request::Request;
use crate::paper::lep10::FLOORS;
use crate::paper::lep12::TIME_S;
use crate::refused::refused;
use crate::rigs::Floor;
use host_sim::Error;

/// How many times faster the robot turns and runs, to see what speed does.
const FASTER: f64 = 4.0;

/// Mean and standard deviation of one channel of a floor.
fn moments(streams: &[Stream], floor: usize, channel: usize) -> (f64, f64) {
    let mine = streams.iter().filter(|stream| stream.floor == floor);
    let values = mine.flat_map(|stream| stream.samples.iter().skip(channel).step_by(CHANNELS));
    crate::moments::moments(values.copied())
}

/// Lag at which the correlation of one channel falls to 1/e, samples; the mean
/// over the streams.
fn correlation(streams: &[Stream], channel: usize) -> f64 {
    let lag = |stream: &Stream| {
        let line: Vec<f64> = stream
            .samples
            .iter()
            .skip(channel)
            .step_by(CHANNELS)
            .copied()
            .collect();
        let mean = line.iter().sum::<f64>() / line.len().max(1) as f64;
        let at = |lag: usize| -> f64 {
            let pairs = line.iter().zip(line.iter().skip(lag));
            pairs.map(|(a, b)| (a - mean) * (b - mean)).sum()
        };
        let all = at(0);
        let lags = (0..line.len() / 4).step_by(4);
        lags.into_iter()
            .find(|lag| at(*lag) < all / core::f64::consts::E)
            .unwrap_or(line.len() / 4)
    };
    let sum: usize = streams.iter().map(lag).sum();
    sum as f64 / streams.len().max(1) as f64
}

/// How far two floors are apart in a channel, in their mean spread.
fn apart(streams: &[Stream], [a, b]: [usize; 2], channel: usize) -> f64 {
    let (one, other) = (moments(streams, a, channel), moments(streams, b, channel));
    (one.0 - other.0).abs() / (0.5 * (one.1 + other.1)).max(1e-9)
}

/// The two floors that are most alike, by both channels together.
fn alike(streams: &[Stream]) -> ([usize; 2], [f64; 2]) {
    let mut best = ([0, 1], [f64::INFINITY; 2]);
    for a in 0..FLOORS.len() {
        for b in a + 1..FLOORS.len() {
            let found = [0, 1].map(|channel| apart(streams, [a, b], channel));
            if found[0].hypot(found[1]) < best.1[0].hypot(best.1[1]) {
                best = ([a, b], found);
            }
        }
    }
    best
}

/// What the distributions of one group of trials are like.
pub(super) fn distributions(group: &Group, rate_hz: f64) -> String {
    let streams = &group.training;
    let ([a, b], [x, y]) = alike(streams);
    let lags = [0, 1].map(|channel| 1000.0 * correlation(streams, channel) / rate_hz);
    format!(
        "x stays correlated for {:.0} ms and y for {:.0} ms (1/e), so that {:.0} ms hold about \
         {:.0} independent values of x; {} and {} are the most alike, {x:.1} spreads apart in the \
         mean of x and {y:.1} in that of y, while their spectra differ",
        lags[0],
        lags[1],
        1000.0 * TIME_S,
        (1000.0 * TIME_S / (2.0 * lags[0].max(1e-3))).max(1.0),
        FLOORS[a],
        FLOORS[b],
    )
}

/// The same experiment on another robot: what a window of 200 ms and the
/// sequential rule make of rotating motion, percent.
fn variation(request: &Request, change: impl FnOnce(&mut Floor)) -> Result<[f64; 2], Error> {
    let (other, recordings) = on_other_rigs(request, Dataset::Floor, |other| {
        change(&mut other.rigs.floor);
    })?;
    let floors = Floors::new(&other, &recordings);
    let groups = Group::all(&floors)?;
    let rotating = groups.get(2).ok_or_else(|| refused("no group"))?;
    let curves = Curves::of(rotating, floors.rate_hz)?;
    let window = rotating.window(floors.samples(TIME_S) as u32, floors.rate_hz)?;
    let sequential = curves.nearest().map_or(0.0, |point| point.tally.mean_hit());
    Ok([window.tally.mean_hit(), sequential])
}

/// How much depends on what the paper does not say of the robot.
pub(super) fn robots(request: &Request) -> Result<String, Error> {
    let level = variation(request, |floor| {
        floor.sink_m = [0.0; 4];
        floor.wobble_share = 0.0;
    })?;
    let faster = variation(request, |floor| {
        floor.turn_rad_s *= FASTER;
        floor.forward_m_s *= FASTER;
    })?;
    Ok(format!(
        "On rotating motion the window of 200 ms and the sequential rule have {:.1} and {:.1} % \
         with a robot that neither sinks into pile nor rocks on rough ground (so that the mean of \
         y hardly differs between floors), and {:.1} and {:.1} % with one {FASTER:.0} times as fast",
        level[0], level[1], faster[0], faster[1]
    ))
}
