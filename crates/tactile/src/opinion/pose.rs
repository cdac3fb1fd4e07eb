//! How what is touched stands, by the way of the touch: its tilt, and how deep it reaches.
//!
//! The way is the mean deflection (x, y) of each block ([`super`]). After k blocks, with the sums
//! over the blocks of each state that has begun and the sums X, Y over all k,
//!
//! estimate = b + Σ (u x + v y) + p X² + q XY + r Y²
//!
//! with weights of their own for each class and k, as friction turns a deflection as a tilt does:
//! of a surface whose friction is not known the tilt cannot be. The error beside an estimate is the
//! root mean square over touches of poses that its weights have not seen. An estimate stays within
//! the poses of training; by what it would lie beyond them its error is larger. Both hold for the
//! sensor and the surfaces of training: another scale, a
//! turn about the shaft and another friction bend a whisker as another pose does, and the error
//! knows of them only what differed between the recordings.

use super::STATES;
use super::section::begun;

/// A number and its error, in hundredths of the unit that it was trained in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Estimate {
    /// The number.
    pub hundredths: i16,
    /// Root mean square of its error.
    pub error_hundredths: u16,
}

/// How what is touched stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Pose {
    /// Its tilt; of simulated recordings in degrees.
    pub tilt: Estimate,
    /// How far the whisk would go beyond where it is met; likewise.
    pub depth: Estimate,
}

impl Estimate {
    /// The number.
    pub fn value(self) -> f64 {
        f64::from(self.hundredths) / 100.0
    }

    /// Root mean square of its error.
    pub fn error(self) -> f64 {
        f64::from(self.error_hundredths) / 100.0
    }

    const fn word(self) -> u32 {
        self.hundredths.cast_unsigned() as u32 | (self.error_hundredths as u32) << 16
    }

    const fn from_word(word: u32) -> Self {
        Self {
            hundredths: (word as u16).cast_signed(),
            error_hundredths: (word >> 16) as u16,
        }
    }
}

impl Pose {
    /// As it is sent.
    pub const fn words(self) -> [u32; 2] {
        [self.tilt.word(), self.depth.word()]
    }

    /// As it was sent.
    pub const fn from_words([tilt, depth]: [u32; 2]) -> Self {
        Self {
            tilt: Estimate::from_word(tilt),
            depth: Estimate::from_word(depth),
        }
    }
}

/// What is estimated: tilt and depth.
pub(crate) const TARGETS: usize = 2;
pub(crate) const MOST_INPUTS: usize = 2 * STATES.len() + 3;
/// Bits that are left off a product of sums.
const PRODUCT_BITS: u32 = 10;
/// Words that hold for all classes: the least and the most of each target.
pub(crate) const LIMIT_WORDS: usize = TARGETS;

pub(crate) fn inputs_of(blocks: usize) -> usize {
    2 * begun(blocks) + 3
}

/// Words of a class and a stage: both errors; both shifts; a bias and a weight an input, twice.
pub(crate) fn stage_words(stage: usize) -> usize {
    2 + TARGETS * (1 + inputs_of(stage))
}

/// What is weighed of a way, in [`inputs_of`] its blocks; zeros behind. Each is below 2²⁸: the ways
/// of eight blocks are below 2¹⁸.
pub(crate) fn inputs(path: &[[i16; 2]]) -> [i32; MOST_INPUTS] {
    let mut inputs = [0; MOST_INPUTS];
    let mut sums = [0_i32; 2];
    let begun = begun(path.len());
    for (state, of_state) in STATES.iter().zip(inputs.chunks_exact_mut(2)).take(begun) {
        let [first, end] = *state;
        for block in path.get(first..end.min(path.len())).unwrap_or_default() {
            for ((of_state, sum), code) in of_state.iter_mut().zip(&mut sums).zip(block) {
                *of_state += i32::from(*code);
                *sum += i32::from(*code);
            }
        }
    }
    let [x, y] = sums.map(i64::from);
    let products = [x * x, x * y, y * y].map(|product| (product >> PRODUCT_BITS) as i32);
    for (input, product) in inputs.iter_mut().skip(2 * begun).zip(products) {
        *input = product;
    }
    inputs
}

/// The estimate of a way by the words of its class and stage, within limits; none of words that
/// are too few.
// Once a decision.
#[inline(never)]
pub(crate) fn estimate(
    path: &[[i16; 2]],
    words: &[u32],
    limits: [u32; LIMIT_WORDS],
) -> Option<Pose> {
    let [errors, shifts, rest @ ..] = words else {
        return None;
    };
    let inputs = inputs(path);
    let mut of_targets = rest.chunks_exact(1 + inputs_of(path.len()));
    let mut target = |half: u32, limits: u32| {
        let (bias, weights) = of_targets.next()?.split_first()?;
        let weighed = weights.iter().zip(inputs);
        let sum: i64 = weighed
            .map(|(weight, input)| i64::from(weight.cast_signed()) * i64::from(input))
            .fold(0, i64::wrapping_add);
        let shift = (shifts >> half) & 63;
        let value = (sum >> shift).saturating_add(bias.cast_signed().into());
        let [least, most] = [limits, limits >> 16].map(|limit| (limit as u16).cast_signed());
        // Within 16 bits; limits that contradict each other are no trainer's.
        let within = value.min(most.into()).max(least.into());
        let beyond = value.abs_diff(within).min(u16::MAX.into()) as u16;
        Some(Estimate {
            hundredths: within as i16,
            error_hundredths: ((errors >> half) as u16).saturating_add(beyond),
        })
    };
    let [of_tilt, of_depth] = limits;
    Some(Pose {
        tilt: target(0, of_tilt)?,
        depth: target(16, of_depth)?,
    })
}
