//! The floor robot's recordings as LEP10 and LEP12 use them: the first half of
//! every trial to train on, the second to validate with.

use anyhow::Result;
use rayon::prelude::*;
use tactile::score::Confusion;
use tactile::train::{Options, Trainer};
use tactile::{ModelBuf, WindowRule};

use super::{Dataset, Extent, Recording, Recordings, Request, of_set};
use crate::chart::Series;
use crate::classifiers::recogniser::{Bayes, Recogniser};
use crate::moments::range;
use crate::page::percent_of;
use crate::paper::lep10::FLOORS;
use crate::rigs::{RobotMotion, trials};

/// Sensor codes of 10 mV: 14 bits over 5 V.
const CODES_A_BIN: f64 = 16_384.0 * 0.010 / 5.0;
/// Standard deviation of the smoothing, bins (100 mV).
const SMOOTH_BINS: f64 = 10.0;
pub(super) const CHANNELS: usize = 2;

#[derive(Debug, Clone)]
pub(super) struct Stream {
    pub(super) floor: usize,
    pub(super) samples: Vec<f64>,
}

impl Stream {
    fn picked(&self, channels: &[usize]) -> Vec<f64> {
        let samples = self.samples.chunks_exact(CHANNELS);
        samples
            .flat_map(|sample| channels.iter().map(|&channel| sample[channel]))
            .collect()
    }
}

pub(super) struct Floors<'a> {
    recordings: Vec<&'a Recording>,
    extent: Extent,
    /// Trials of natural motion that are used.
    natural: usize,
    pub(super) rate_hz: f64,
}

impl<'a> Floors<'a> {
    pub(super) fn new(request: &Request, recordings: &'a Recordings, natural: usize) -> Self {
        Self {
            recordings: of_set(recordings, Dataset::Floor),
            extent: request.extent,
            natural,
            rate_hz: request.rigs.floor.tick_hz,
        }
    }

    pub(super) fn halves(&self, motions: &[RobotMotion]) -> [Vec<Stream>; 2] {
        let mut halves = [Vec::new(), Vec::new()];
        let trials = trials(self.extent).into_iter().zip(&self.recordings);
        for ((floor, motion, trial), recording) in trials {
            let is_left_out = motion == RobotMotion::Autonomous && trial >= self.natural;
            if is_left_out || !motions.contains(&motion) {
                continue;
            }
            let (middle, end) = (recording.len() / 2, recording.len());
            for (half, (from, to)) in halves.iter_mut().zip([(0, middle), (middle, end)]) {
                let samples = recording.segment(from, to);
                half.push(Stream { floor, samples });
            }
        }
        halves
    }

    pub(super) fn samples(&self, seconds: f64) -> usize {
        (seconds * self.rate_hz).round() as usize
    }
}

/// Likelihoods in bins of 10 mV over the range that x and y have together
/// (LEP10 section III-A), of some of the channels; classes are the floors that occur.
///
/// The model's bins span each channel's own range, so every class is given the
/// common range's two ends as samples: 2 among some 10⁵.
pub(super) fn train(streams: &[Stream], picked: &[usize], block: u32) -> Result<ModelBuf> {
    let all = streams.iter().flat_map(|stream| &stream.samples).copied();
    let (low, high) = range(all);
    let bins = ((high - low) / CODES_A_BIN).ceil().clamp(1.0, 4096.0) as usize;
    let options = Options {
        bins,
        smooth: SMOOTH_BINS,
        block,
    };
    let mut trainer = Trainer::new(picked.len(), options)?;
    for stream in streams {
        let name = FLOORS[stream.floor];
        for sample in stream.picked(picked).chunks_exact(picked.len()) {
            trainer.add(name, sample)?;
        }
    }
    for (floor, name) in FLOORS.iter().enumerate() {
        if streams.iter().any(|stream| stream.floor == floor) {
            trainer.add(name, &vec![low; picked.len()])?;
            trainer.add(name, &vec![high; picked.len()])?;
        }
    }
    trainer.train().map_err(anyhow::Error::new)
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tally {
    pub(super) confusion: Confusion,
    samples: u64,
}

impl Tally {
    /// What a recogniser makes of some channels of all streams, each from its start.
    pub(super) fn of<R: Recogniser>(
        streams: &[Stream],
        channels: &[usize],
        new: impl Fn() -> Result<R> + Sync,
    ) -> Result<Self> {
        let found = streams.par_iter().map(|stream| {
            let samples = stream.picked(channels);
            Ok((stream.floor, new()?.outcomes(&samples, channels.len())))
        });
        let mut tally = Self::empty();
        for (floor, outcomes) in found.collect::<Result<Vec<_>>>()? {
            for outcome in outcomes {
                tally.add(floor, outcome.class, u64::from(outcome.samples))?;
            }
        }
        Ok(tally)
    }

    pub(super) fn of_windows(
        streams: &[Stream],
        channels: &[usize],
        model: &ModelBuf,
        window: u32,
    ) -> Result<Self> {
        let model = model.view();
        Self::of(streams, channels, || {
            Ok(Bayes::<WindowRule>::new(model, window)?)
        })
    }

    pub(super) fn empty() -> Self {
        Self {
            confusion: Confusion::new(FLOORS.len()),
            samples: 0,
        }
    }

    pub(super) fn add(&mut self, floor: usize, decided: usize, samples: u64) -> Result<()> {
        self.confusion.add(floor, Some(decided))?;
        self.samples += samples;
        Ok(())
    }

    pub(super) fn hits(&self) -> [f64; 4] {
        core::array::from_fn(|floor| percent_of(&self.confusion, floor, floor))
    }

    pub(super) fn mean_hit(&self) -> f64 {
        self.hits().iter().sum::<f64>() / 4.0
    }

    pub(super) fn mean_samples(&self) -> f64 {
        self.samples as f64 / self.confusion.named().max(1) as f64
    }
}

/// Hit rates of each floor, and their mean by a name, percent, over what is varied.
pub(super) fn hit_curves<'t>(
    points: impl Iterator<Item = (f64, &'t Tally)>,
    mean: &str,
) -> [Series; 5] {
    let points: Vec<(f64, &Tally)> = points.collect();
    core::array::from_fn(|n| {
        let hit = |tally: &Tally| match FLOORS.get(n) {
            Some(_) => tally.hits()[n],
            None => tally.mean_hit(),
        };
        let points = points.iter().map(|(x, tally)| (*x, hit(tally)));
        Series::curve(FLOORS.get(n).unwrap_or(&mean), points.collect())
    })
}

#[cfg(test)]
mod tests {
    use super::{Stream, Tally, train};

    /// Floors that differ in x by 500 codes and not in y.
    fn streams() -> Vec<Stream> {
        let stream = |floor: usize| Stream {
            floor,
            samples: (0..4000)
                .flat_map(|n| [500.0 * floor as f64 + f64::from(n % 97), f64::from(n % 89)])
                .collect(),
        };
        (0..4).map(stream).collect()
    }

    #[test]
    fn a_channel_that_tells_floors_apart_does_alone_or_beside_one_that_does_not() {
        let streams = streams();
        for (picked, expected) in [(vec![0], 100.0), (vec![1], 25.0), (vec![0, 1], 100.0)] {
            let buf = train(&streams, &picked, 1).unwrap();
            let bins = buf.view().bins(0);
            assert_eq!(bins, Some(49), "1596 codes in bins of 32.77");
            let tally = Tally::of_windows(&streams, &picked, &buf, 100).unwrap();
            assert!((tally.mean_hit() - expected).abs() < 1e-9, "{tally:?}");
            assert!((tally.mean_samples() - 100.0).abs() < 1e-9);
        }
    }
}
