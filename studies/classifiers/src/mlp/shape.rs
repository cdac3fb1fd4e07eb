//! How many units a network has, and how its weights stand in one slice.

use crate::error::Error;
use crate::limits::{MAX_HIDDEN, MAX_INPUTS, MAX_OUTPUTS};

/// Units of a network.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shape {
    /// Inputs I, 1 to 4096.
    pub inputs: usize,
    /// Hidden units H, 1 to 1024.
    pub hidden: usize,
    /// Outputs O, that is classes, 2 to 256.
    pub outputs: usize,
}

impl Shape {
    /// Refuses a shape outside the limits.
    pub(super) const fn check(self) -> Result<(), Error> {
        if self.inputs == 0 || self.inputs > MAX_INPUTS {
            return Err(Error::Inputs(self.inputs));
        }
        if self.hidden == 0 || self.hidden > MAX_HIDDEN {
            return Err(Error::Hidden(self.hidden));
        }
        if self.outputs < 2 || self.outputs > MAX_OUTPUTS {
            return Err(Error::Outputs(self.outputs));
        }
        Ok(())
    }

    /// Weights and biases: I H + H + O H + O. They stand in this order: for
    /// each input its H weights, the H biases, for each output its H weights,
    /// the O biases.
    pub fn weights(self) -> usize {
        (self.inputs + 1) * self.hidden + (self.hidden + 1) * self.outputs
    }

    /// The four groups of a slice of all weights.
    #[cfg(feature = "train")]
    pub(super) fn parts(self, weights: &[f64]) -> Parts<'_> {
        let (input, rest) = weights.split_at(self.inputs * self.hidden);
        let (hidden_bias, rest) = rest.split_at(self.hidden);
        let (output, output_bias) = rest.split_at(self.outputs * self.hidden);
        Parts {
            input,
            hidden_bias,
            output,
            output_bias,
        }
    }
}

/// Weights by what they belong to.
#[cfg(feature = "train")]
#[derive(Debug, Clone, Copy)]
pub(super) struct Parts<'w> {
    /// `[input][hidden]`.
    pub(super) input: &'w [f64],
    /// `[hidden]`.
    pub(super) hidden_bias: &'w [f64],
    /// `[output][hidden]`.
    pub(super) output: &'w [f64],
    /// `[output]`.
    pub(super) output_bias: &'w [f64],
}
