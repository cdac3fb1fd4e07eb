//! What the module will see of a trial: blocks of counted samples.

use std::vec::Vec;

use super::trial::{CHANNELS, Options, Trial};
use crate::quantiser::Quantiser;
use crate::roughness::Roughness;
use crate::train::real_quantiser;
use crate::train_error::TrainError;

/// The blocks of a trial, in order.
#[derive(Debug, Clone)]
pub(super) struct Blocks {
    /// Samples of each block.
    length: usize,
    /// Codes of the samples, block after block.
    pub(super) samples: Vec<[i32; CHANNELS]>,
    /// Code of the roughness of each block.
    pub(super) roughness: Vec<[i32; CHANNELS]>,
    /// The number of the touch that each block is of.
    pub(super) touches: Vec<u16>,
}

impl Blocks {
    pub(super) fn of(trial: &Trial, scales: &[Quantiser; CHANNELS], options: &Options) -> Self {
        let length = options.block as usize;
        let mut blocks = Self {
            length,
            samples: Vec::new(),
            roughness: Vec::new(),
            touches: Vec::new(),
        };
        let mut open = Vec::with_capacity(length);
        let mut roughness = Roughness::new();
        let mut last = 0;
        for (sample, &touch) in trial.samples.iter().zip(&trial.touches) {
            let codes: [i32; CHANNELS] =
                core::array::from_fn(|channel| scales[channel].code_from_f64(sample[channel]));
            // As the module, which takes none into a block that has no difference.
            let counts = touch != 0 && roughness.is_full();
            roughness.push(&codes, counts);
            if !counts {
                continue;
            }
            if touch != last {
                last = touch;
                open.clear();
                roughness.clear();
            }
            open.push(codes);
            if open.len() == length {
                blocks.samples.append(&mut open);
                blocks
                    .roughness
                    .push([roughness.code(0), roughness.code(1)]);
                blocks.touches.push(touch);
                roughness.clear();
            }
        }
        blocks
    }

    pub(super) fn len(&self) -> usize {
        self.touches.len()
    }

    pub(super) fn split_off(&mut self, at: usize) -> Self {
        Self {
            length: self.length,
            samples: self.samples.split_off(at * self.length),
            roughness: self.roughness.split_off(at),
            touches: self.touches.split_off(at),
        }
    }
}

/// The codes of each channel: integers keep theirs; other data is scaled so that
/// its range spans above 2¹⁸ codes.
pub(super) fn scales(trials: &[Trial]) -> Result<[Quantiser; CHANNELS], TrainError> {
    let mut scales = [Quantiser::of_codes(0, 0); CHANNELS];
    for (channel, scale) in scales.iter_mut().enumerate() {
        let values = || {
            let samples = trials.iter().flat_map(|trial| &trial.samples);
            samples.map(move |sample| sample[channel])
        };
        if !values().all(f64::is_finite) {
            return Err(TrainError::NotFinite { channel });
        }
        let low = values().fold(f64::INFINITY, f64::min);
        let high = values().fold(f64::NEG_INFINITY, f64::max);
        if values().all(|x| x.trunc() == x && x.abs() < f64::from(1 << 28)) {
            // Codes as they are. A span of one or two is none that a model can hold.
            if high - low > 2.0 {
                [scale.low, scale.high] = [low as i32, high as i32];
            }
            continue;
        }
        *scale = real_quantiser(low, high, 128).ok_or(TrainError::Range { channel })?;
    }
    Ok(scales)
}
