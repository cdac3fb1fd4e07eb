//! What the module feels of each touch of the recordings: features and mean deflections.

use std::vec::Vec;

use crate::opinion::differences::{FEATURE_BITS, NARROW_MOST};
use crate::opinion::{BLOCKS, DEFLECTION_SHIFT, Differences, FEATURES, Narrow, STATES, blocks_of};
use crate::quantiser::Quantiser;
use crate::roughness;
use crate::train::joint::{CHANNELS, Trial};

/// A touch, or nine blocks of a longer one.
#[derive(Debug, Clone)]
pub(super) struct Touch {
    pub(super) class: usize,
    /// The recording, and the copy of it.
    pub(super) recording: usize,
    /// Whether it goes on with a touch of which nine blocks came before.
    pub(super) goes_on: bool,
    /// The trial, over all recordings.
    pub(super) trial: usize,
    /// Of each block.
    pub(super) features: Vec<[f64; FEATURES]>,
    /// Mean deflection of each block, narrow codes.
    pub(super) path: Vec<[f64; CHANNELS]>,
}

impl Touch {
    pub(super) fn len(&self) -> usize {
        self.path.len()
    }

    /// Means of the features over a state, after so many blocks; none before it begins.
    pub(super) fn state(&self, state: usize, blocks: usize) -> Option<[f64; FEATURES]> {
        let [first, _] = STATES[state];
        let count = blocks_of(STATES[state], blocks.min(self.len()));
        let of_state = self.features.get(first..first + count)?;
        if of_state.is_empty() {
            return None;
        }
        let mut mean = [0.0; FEATURES];
        for features in of_state {
            for (mean, feature) in mean.iter_mut().zip(features) {
                *mean += feature / count as f64;
            }
        }
        Some(mean)
    }

    /// What is weighed of the states after so many blocks, so many numbers of each.
    pub(super) fn stage(&self, blocks: usize, weighed: usize) -> Vec<f64> {
        let states = (0..STATES.len()).filter_map(|state| {
            let deflection = self.deflection(state, blocks);
            let values = self.state(state, blocks)?.into_iter().chain(deflection);
            Some(values.take(weighed))
        });
        states.flatten().collect()
    }

    /// The mean deflection in a state, as it is weighed.
    fn deflection(&self, state: usize, blocks: usize) -> [f64; CHANNELS] {
        let [first, _] = STATES[state];
        let count = blocks_of(STATES[state], blocks.min(self.len()));
        let of_state = self.path.iter().skip(first).take(count);
        let unit = f64::from(1 << (FEATURE_BITS + DEFLECTION_SHIFT)) * count.max(1) as f64;
        let add = |sum: [f64; CHANNELS], of: &[f64; CHANNELS]| [sum[0] + of[0], sum[1] + of[1]];
        of_state.fold([0.0; CHANNELS], add).map(|sum| sum / unit)
    }
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Sense {
    pub(super) narrow: Narrow,
    /// Mean of the air, or of all where there is none; 1/256 narrow codes.
    pub(super) rest: [i32; CHANNELS],
    pub(super) block: u32,
}

/// What touches are for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Kind {
    /// They are longer than nine blocks: blocks that are not whole do not count.
    pub(super) lasts: bool,
    /// The opinion stands beside tables, whose blocks it shares.
    pub(super) has_tables: bool,
}

/// Codes of a sensor of 14 bits.
const RAW: core::ops::RangeInclusive<i32> = 0..=16383;

impl Sense {
    pub(super) fn of(trials: &[Trial], scales: &[Quantiser; CHANNELS], block: u32) -> Self {
        let low = scales.iter().map(|scale| scale.low).min().unwrap_or(0);
        let high = scales.iter().map(|scale| scale.high).max().unwrap_or(0);
        let is_raw = RAW.contains(&low) && RAW.contains(&high);
        let takes_raw = scales
            .iter()
            .all(|scale| scale.takes_raw() && scale.exponent == 0);
        let narrow = if is_raw && takes_raw {
            Narrow {
                centre: NARROW_MOST + 1,
                shift: 0,
            }
        } else {
            // The range of training fills half of what there is.
            let span = high.wrapping_sub(low).unsigned_abs();
            let bits = u32::BITS - span.leading_zeros();
            Narrow {
                centre: low.wrapping_add((span / 2).cast_signed()),
                shift: bits.saturating_sub(13),
            }
        };
        let mut sense = Self {
            narrow,
            rest: [0; CHANNELS],
            block,
        };
        sense.rest = sense.mean(trials, scales);
        sense
    }

    fn mean(&self, trials: &[Trial], scales: &[Quantiser; CHANNELS]) -> [i32; CHANNELS] {
        let has_air = trials.iter().any(|trial| trial.touches.contains(&0));
        let (mut sums, mut count) = ([0_i64; CHANNELS], 0_i64);
        for trial in trials {
            let felt = trial.samples.iter().zip(&trial.touches);
            for (sample, _) in felt.filter(|(_, touch)| **touch == 0 || !has_air) {
                count += 1;
                for (sum, code) in sums.iter_mut().zip(self.codes(sample, scales)) {
                    *sum += i64::from(code);
                }
            }
        }
        // Of 14 bits.
        sums.map(|sum| (256 * sum / count.max(1)) as i32)
    }

    fn codes(&self, sample: &[f64; CHANNELS], scales: &[Quantiser; CHANNELS]) -> [i16; CHANNELS] {
        core::array::from_fn(|n| self.narrow.of(scales[n].code_from_f64(sample[n])))
    }

    /// The touches of trials whose deflections are `gains` times what they were. `classes` and
    /// `recordings` have a number a trial.
    pub(super) fn touches(
        &self,
        trials: &[Trial],
        scales: &[Quantiser; CHANNELS],
        (classes, recordings): (&[usize], &[usize]),
        (gains, kind): ([f64; CHANNELS], Kind),
    ) -> Vec<Touch> {
        let mut touches: Vec<Touch> = Vec::new();
        let mut last_recording = None;
        let mut differences = Differences::new(self.rest);
        let rest = self.rest.map(|rest| f64::from(rest) / 256.0);
        let most = f64::from(NARROW_MOST);
        for (trial, of) in trials.iter().enumerate() {
            if last_recording != Some(recordings[trial]) {
                last_recording = Some(recordings[trial]);
                differences = Differences::new(self.rest);
            }
            // As a classifier that takes a trial for itself.
            differences.interrupt();
            differences.clear();
            let (mut last, mut open, mut is_new) = (0, 0, true);
            for (at, (sample, &touch)) in of.samples.iter().zip(&of.touches).enumerate() {
                let felt = self.codes(sample, scales);
                let codes = core::array::from_fn(|n| {
                    let code = rest[n] + gains[n] * (f64::from(felt[n]) - rest[n]);
                    code.round().clamp(-most - 1.0, most) as i16
                });
                if touch != 0 && touch != last {
                    last = touch;
                    (open, is_new) = (0, true);
                    differences.clear();
                }
                differences.push(codes, touch != 0);
                // Blocks are those of the tables beside it.
                if touch == 0 || (kind.has_tables && at < roughness::KEPT) {
                    continue;
                }
                open += 1;
                if open < self.block {
                    continue;
                }
                open = 0;
                let is_whole = differences.is_whole();
                let (features, path) = differences.end_of_block();
                if kind.lasts && !is_whole {
                    continue;
                }
                if is_new || touches.last().is_none_or(|touch| touch.len() == BLOCKS) {
                    let goes_on = !core::mem::replace(&mut is_new, false);
                    touches.push(Touch {
                        class: classes[trial],
                        recording: recordings[trial],
                        goes_on,
                        trial,
                        features: Vec::new(),
                        path: Vec::new(),
                    });
                }
                let unit = f64::from(1 << FEATURE_BITS);
                if let Some(touch) = touches.last_mut() {
                    touch.features.push(features.map(|f| f64::from(f) / unit));
                    touch.path.push(path.map(f64::from));
                }
            }
        }
        touches
    }
}

#[cfg(test)]
mod tests {
    use std::vec;

    use super::*;

    fn trial(level: f64, step: f64) -> Trial {
        let sample = |n: u32| {
            [
                level + step * f64::from(n % 7),
                level - step * f64::from(n % 5),
            ]
        };
        Trial {
            samples: (0..200).map(sample).collect(),
            touches: vec![1; 200],
            ..Trial::default()
        }
    }

    /// As a classifier feels it that begins with the trial: differences need 64 samples before.
    #[test]
    fn a_trial_is_felt_for_itself_and_where_touches_last_by_whole_blocks() {
        let sense = Sense {
            narrow: Narrow {
                centre: NARROW_MOST + 1,
                shift: 0,
            },
            rest: [0; CHANNELS],
            block: 40,
        };
        let scales = [Quantiser::of_codes(0, 16_384); CHANNELS];
        let felt = |trials: &[Trial], lasts| {
            let kind = Kind {
                lasts,
                has_tables: lasts,
            };
            let numbers = vec![0; trials.len()];
            let touches = sense.touches(
                trials,
                &scales,
                (&numbers, &numbers),
                ([1.0; CHANNELS], kind),
            );
            touches.last().unwrap().features.clone()
        };
        let [before, trial] = [trial(3_000.0, 400.0), trial(12_000.0, 30.0)];
        let pair = [before, trial.clone()];
        for (lasts, blocks) in [(false, 5), (true, 2)] {
            let alone = felt(core::slice::from_ref(&trial), lasts);
            assert_eq!(alone.len(), blocks);
            assert_eq!(felt(&pair, lasts), alone);
        }
    }
}
