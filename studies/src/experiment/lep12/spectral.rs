//! The spectral methods of LEP12 section 5: the template of the power
//! spectrum, and a neural network of 120–20–4 units on it.
//!
//! Both take x and y, as the other classifiers do, up to 120 Hz: above that "the power is close to
//! zero". The template takes every bin above zero frequency: the paper's spectra show no offset;
//! that it ends at 120 Hz is ours. The network's 120 inputs are 2 to 120 Hz in steps of 2 Hz of
//! each of them (a transform of half a second, the 400 ms and zeros; the paper does not say how 120
//! inputs come of 400 ms).

use anyhow::Result;
use rayon::prelude::*;

use super::groups::Group;
use crate::classifiers::network::{self, Options, Row};
use crate::classifiers::{Bins, POWER, Spectrum, Templates};
use crate::experiment::floors::{CHANNELS, Stream, Tally};
use crate::paper::lep12::SEGMENT_S;
use crate::rigs::seed_of;

/// Highest frequency, Hz.
const HIGHEST_HZ: f64 = 120.0;
/// Length of the network's transform, s.
const TRANSFORM_S: f64 = 0.5;

fn rows(
    streams: &[Stream],
    rate_hz: f64,
    of: impl Fn(&[f64]) -> Result<Vec<f64>>,
) -> Result<Vec<Row>> {
    let block = (SEGMENT_S * rate_hz).round() as usize;
    let mut rows = Vec::new();
    for stream in streams {
        for segment in stream.samples.chunks_exact(block * CHANNELS) {
            rows.push((stream.floor, of(segment)?));
        }
    }
    Ok(rows)
}

pub(super) fn template(group: &Group, rate_hz: f64) -> Result<[f64; 4]> {
    let block = (SEGMENT_S * rate_hz).round() as usize;
    let spectrum = Spectrum::new(Bins::between(block, rate_hz, 1.0, HIGHEST_HZ)?);
    let of = |segment: &[f64]| -> Result<Vec<f64>> {
        let line = |channel| segment.iter().skip(channel).step_by(CHANNELS).copied();
        let powers = (0..CHANNELS).map(|channel| spectrum.of(line(channel), POWER));
        Ok(powers.collect::<Result<Vec<_>>>()?.concat())
    };
    let known = rows(&group.training, rate_hz, of)?;
    let known = known.iter().map(|(floor, row)| (*floor, &row[..]));
    let templates = Templates::of(known, false)?;
    let mut tally = Tally::empty();
    for (floor, row) in rows(&group.validation, rate_hz, of)? {
        tally.add(floor, templates.classify(&row), block as u64)?;
    }
    Ok(tally.hits())
}

pub(super) fn power(spectrum: &Spectrum, segment: &[f64], channel: usize) -> Result<Vec<f64>> {
    let line = || segment.iter().skip(channel).step_by(CHANNELS);
    let mean = line().sum::<f64>() / (segment.len() / CHANNELS) as f64;
    spectrum.of(line().map(|x| x - mean), POWER)
}

/// Hit rates of the network, percent: the mean of ten trainings.
pub(super) fn network(group: &Group, rate_hz: f64, seed: u64) -> Result<[f64; 4]> {
    const SESSIONS: u64 = 10;
    let points = (TRANSFORM_S * rate_hz).round() as usize;
    let spectrum = Spectrum::new(Bins::between(points, rate_hz, 1.0, HIGHEST_HZ)?);
    let of = |segment: &[f64]| -> Result<Vec<f64>> {
        let powers = (0..CHANNELS).map(|channel| power(&spectrum, segment, channel));
        Ok(powers.collect::<Result<Vec<_>>>()?.concat())
    };
    let training = rows(&group.training, rate_hz, of)?;
    let validation = rows(&group.validation, rate_hz, of)?;
    let session = |number: u64| {
        let options = Options::spectrum(seed_of(seed, &[12, number]));
        // Floors that cannot be separated leave no start that names each of them.
        let any = Options {
            reliable: 0.0,
            ..options
        };
        let network = network::train(&training, &options);
        let network = network.or_else(|_| network::train(&training, &any))?;
        let mut tally = Tally::empty();
        for (floor, row) in &validation {
            tally.add(*floor, network.classify(row)?, 1)?;
        }
        Ok(tally.hits())
    };
    let sessions = (0..SESSIONS).into_par_iter().map(session);
    let sessions = sessions.collect::<Result<Vec<[f64; 4]>>>()?;
    let mean = |k: usize| sessions.iter().map(|hits| hits[k]).sum::<f64>() / SESSIONS as f64;
    Ok(core::array::from_fn(mean))
}
