//! What the module will see of a trial: blocks of counted samples.

use std::collections::VecDeque;
use std::vec::Vec;

use super::trial::{CHANNELS, Options, Trial};
use crate::quantiser::Quantiser;
use crate::train::real_quantiser;
use crate::train_error::TrainError;

/// Samples between the terms of the roughness.
const DELAY: usize = 4;

/// The blocks of a trial, in order.
#[derive(Debug, Clone)]
pub(super) struct Blocks {
    /// Samples of each block.
    length: usize,
    /// Codes of the samples, block after block.
    pub(super) samples: Vec<[i32; CHANNELS]>,
    /// Code of the roughness of each block: 64 log₂(1 + Σ |v[n] − 2 v[n−4] + v[n−8]|).
    pub(super) roughness: Vec<[i32; CHANNELS]>,
    /// The touch that each block is of, counted from 1.
    pub(super) touches: Vec<u32>,
}

impl Blocks {
    /// Of a trial. Its first counted sample begins a touch, and so does the first
    /// after `gap` that do not count. The delay line of the roughness is as at rest
    /// at the first sample before it.
    pub(super) fn of(trial: &Trial, scales: &[Quantiser; CHANNELS], options: &Options) -> Self {
        let length = options.block as usize;
        let mut blocks = Self {
            length,
            samples: Vec::new(),
            roughness: Vec::new(),
            touches: Vec::new(),
        };
        let mut open = Vec::with_capacity(length);
        let mut sums = [0_u64; CHANNELS];
        let mut line: VecDeque<[i32; CHANNELS]> = VecDeque::new();
        let (mut touch, mut away) = (0, options.gap);
        for (sample, &counts) in trial.samples.iter().zip(&trial.counts) {
            let codes: [i32; CHANNELS] =
                core::array::from_fn(|channel| scales[channel].code_from_f64(sample[channel]));
            if line.is_empty() {
                line.resize(2 * DELAY, codes);
            }
            let (oldest, middle) = (line[0], line[DELAY]);
            line.pop_front();
            line.push_back(codes);
            if !counts {
                away = away.saturating_add(1);
                continue;
            }
            if away >= options.gap {
                touch += 1;
                open.clear();
                sums = [0; CHANNELS];
            }
            away = 0;
            open.push(codes);
            for channel in 0..CHANNELS {
                let [new, middle, old] =
                    [codes, middle, oldest].map(|codes| i64::from(codes[channel]));
                sums[channel] += (new - 2 * middle + old).unsigned_abs();
            }
            if open.len() == length {
                blocks.samples.append(&mut open);
                blocks.roughness.push(sums.map(octaves));
                blocks.touches.push(touch);
                sums = [0; CHANNELS];
            }
        }
        blocks
    }

    /// How many.
    pub(super) fn len(&self) -> usize {
        self.touches.len()
    }

    /// Cuts off those from `at` on.
    pub(super) fn split_off(&mut self, at: usize) -> Self {
        Self {
            length: self.length,
            samples: self.samples.split_off(at * self.length),
            roughness: self.roughness.split_off(at),
            touches: self.touches.split_off(at),
        }
    }
}

/// 64 log₂(1 + sum), linear between powers of two, as the module has it.
fn octaves(sum: u64) -> i32 {
    let x = u32::try_from(sum).unwrap_or(u32::MAX).saturating_add(1);
    let whole = x.ilog2();
    let fraction = (u64::from(x) << 6 >> whole) - 64;
    (whole as i32) * 64 + fraction as i32
}

/// The codes of each channel: integers keep theirs; other data is scaled so that
/// its range spans above 2¹⁸ codes.
pub(super) fn scales(trials: &[Trial]) -> Result<[Quantiser; CHANNELS], TrainError> {
    let mut scales = [Quantiser {
        origin: 0.0,
        exponent: 0,
        low: 0,
        high: 0,
    }; CHANNELS];
    for (channel, scale) in scales.iter_mut().enumerate() {
        let values = || {
            let samples = trials.iter().flat_map(|trial| &trial.samples);
            samples.map(move |sample| sample[channel])
        };
        if !values().all(f64::is_finite) {
            return Err(TrainError::NotFinite { channel });
        }
        if values().all(|x| x.trunc() == x && x.abs() < f64::from(1 << 28)) {
            continue;
        }
        let low = values().fold(f64::INFINITY, f64::min);
        let high = values().fold(f64::NEG_INFINITY, f64::max);
        *scale = real_quantiser(low, high, 128).ok_or(TrainError::Range { channel })?;
    }
    Ok(scales)
}
