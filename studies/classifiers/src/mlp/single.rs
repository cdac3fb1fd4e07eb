//! A network in single precision, input by input.

use super::logistic::logistic;
use super::shape::Shape;
use crate::error::Error;
use crate::limits::{MAX_SCALED, MAX_WEIGHT};

/// One input: its scale, and its weight in each of H hidden units. They lie
/// together so that one walk through memory serves a push.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MlpInput<const H: usize> {
    /// Subtracted from the input, in the input's unit: its mean in training.
    pub offset: f32,
    /// Then multiplied with it: one over its standard deviation in training,
    /// nought for an input that was constant.
    pub gain: f32,
    /// W_ij for all j.
    pub weights: [f32; H],
}

/// A trained network of I inputs, H hidden units and O outputs: an immutable
/// configuration of 4 (I (H + 2) + H + O (H + 1)) bytes that may lie in flash.
///
/// Outputs are within 2e-6 of the f64 network's for trained networks of the
/// papers' sizes (LEP12 section 5.2: 120–20–4; PSIK section 3.2.1: 33–33–8).
#[derive(Debug, Clone, PartialEq)]
pub struct Mlp<const I: usize, const H: usize, const O: usize> {
    inputs: [MlpInput<H>; I],
    hidden_bias: [f32; H],
    output: [[f32; H]; O],
    output_bias: [f32; O],
}

/// The drives of the hidden units so far, and how many inputs they hold.
#[derive(Debug, Clone, PartialEq)]
pub struct MlpState<const H: usize> {
    drives: [f32; H],
    next: usize,
}

impl<const I: usize, const H: usize, const O: usize> Mlp<I, H, O> {
    const SHAPE: Shape = Shape {
        inputs: I,
        hidden: H,
        outputs: O,
    };

    /// A network of its numbers; `const`, so it can be a `static`.
    ///
    /// # Errors
    ///
    /// The shape is outside the limits, or a number is: see [`Error`].
    pub const fn new(
        inputs: [MlpInput<H>; I],
        hidden_bias: [f32; H],
        output: [[f32; H]; O],
        output_bias: [f32; O],
    ) -> Result<Self, Error> {
        let network = Self {
            inputs,
            hidden_bias,
            output,
            output_bias,
        };
        match network.check() {
            Ok(()) => Ok(network),
            Err(error) => Err(error),
        }
    }

    const fn check(&self) -> Result<(), Error> {
        if let Err(error) = Self::SHAPE.check() {
            return Err(error);
        }
        let mut weights = allowed(&self.hidden_bias) && allowed(&self.output_bias);
        let mut i = 0;
        while i < I {
            let MlpInput { offset, gain, .. } = self.inputs[i];
            if !offset.is_finite() || !gain.is_finite() {
                return Err(Error::Scale { input: i });
            }
            weights = weights && allowed(&self.inputs[i].weights);
            i += 1;
        }
        let mut k = 0;
        while k < O {
            weights = weights && allowed(&self.output[k]);
            k += 1;
        }
        if weights { Ok(()) } else { Err(Error::Weight) }
    }

    /// The state before the first input.
    #[inline]
    pub fn state(&self) -> MlpState<H> {
        MlpState {
            drives: self.hidden_bias,
            next: 0,
        }
    }

    /// Takes the next input. The last of the I gives the class, and the state
    /// is then as new. Costs 2 H operations, the last 2 H O and H log-sigmoids
    /// more.
    ///
    /// An input may be any number: scaled, it is limited to ±[`MAX_SCALED`]
    /// (NaN becomes the lower limit), which no input of a training set of a
    /// million samples could exceed.
    #[inline]
    pub fn push(&self, state: &mut MlpState<H>, input: f32) -> Option<usize> {
        self.take(state, input).map(|drives| {
            let mut best = 0;
            let mut highest = f32::NEG_INFINITY;
            for (k, &drive) in drives.iter().enumerate() {
                if drive > highest {
                    highest = drive;
                    best = k;
                }
            }
            best
        })
    }

    /// As [`push`](Self::push), but the last input gives all outputs y, each
    /// between nought and one, at O log-sigmoids more.
    #[inline]
    pub fn push_for_outputs(&self, state: &mut MlpState<H>, input: f32) -> Option<[f32; O]> {
        self.take(state, input).map(|drives| drives.map(logistic))
    }

    /// The drives of the outputs, after the last input.
    #[inline]
    fn take(&self, state: &mut MlpState<H>, x: f32) -> Option<[f32; O]> {
        // There always is one: the state goes back to the first after the last.
        let input = self.inputs.get(state.next)?;
        let z = (x - input.offset) * input.gain;
        #[allow(clippy::manual_clamp, reason = "these two turn NaN into a number")]
        let z = z.max(-MAX_SCALED).min(MAX_SCALED);
        for (drive, &weight) in state.drives.iter_mut().zip(&input.weights) {
            *drive += weight * z;
        }
        state.next += 1;
        if state.next < I {
            return None;
        }
        Some(self.end(state))
    }

    #[inline(never)]
    fn end(&self, state: &mut MlpState<H>) -> [f32; O] {
        let hidden = state.drives.map(logistic);
        *state = self.state();
        let mut drives = self.output_bias;
        for (drive, weights) in drives.iter_mut().zip(&self.output) {
            for (&weight, &h) in weights.iter().zip(&hidden) {
                *drive += weight * h;
            }
        }
        drives
    }
}

/// Whether all weights are within the limit.
const fn allowed(weights: &[f32]) -> bool {
    let mut i = 0;
    while i < weights.len() {
        if weights[i].is_nan() || weights[i].abs() > MAX_WEIGHT {
            return false;
        }
        i += 1;
    }
    true
}
