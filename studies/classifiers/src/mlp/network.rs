//! A network of any shape in f64: what training yields, what experiments run,
//! and what the embedded forms are made from.

use std::vec;
use std::vec::Vec;

use super::error::MlpError;
use super::format::{check_shape, write};
use super::limits::{MAX_SCALED, MAX_WEIGHT};
use super::single::Mlp;

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
    pub(super) fn check(self) -> Result<(), MlpError> {
        check_shape(self.inputs, self.hidden, self.outputs)
    }

    /// Weights and biases: I H + H + O H + O. They stand in this order: for
    /// each input its H weights, the H biases, for each output its H weights,
    /// the O biases.
    pub fn weights(self) -> usize {
        (self.inputs + 1) * self.hidden + (self.hidden + 1) * self.outputs
    }

    /// The four groups of a slice of all weights.
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

/// A network in f64.
#[derive(Debug, Clone, PartialEq)]
pub struct Network {
    shape: Shape,
    offset: Vec<f64>,
    gain: Vec<f64>,
    weights: Vec<f64>,
}

impl Network {
    /// A network of its numbers: offset and gain of each input, and the weights
    /// in the order of [`Shape::weights`].
    ///
    /// # Errors
    ///
    /// The shape or a number is outside its limits, or a slice of another length.
    pub fn new(
        shape: Shape,
        offset: &[f64],
        gain: &[f64],
        weights: &[f64],
    ) -> Result<Self, MlpError> {
        shape.check()?;
        for (expected, found) in [
            (shape.inputs, offset.len()),
            (shape.inputs, gain.len()),
            (shape.weights(), weights.len()),
        ] {
            if expected != found {
                return Err(MlpError::Length { expected, found });
            }
        }
        // As f32 they must be finite too.
        let usable = |x: &f64| (*x as f32).is_finite();
        let scales = offset.iter().zip(gain);
        if let Some(input) = scales.clone().position(|(o, g)| !usable(o) || !usable(g)) {
            return Err(MlpError::Scale { input });
        }
        if !weights.iter().all(|w| w.abs() <= f64::from(MAX_WEIGHT)) {
            return Err(MlpError::Weight);
        }
        Ok(Self {
            shape,
            offset: offset.to_vec(),
            gain: gain.to_vec(),
            weights: weights.to_vec(),
        })
    }

    /// Its units.
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// The weights, in the order of [`Shape::weights`].
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// What is subtracted from each input.
    pub fn offset(&self) -> &[f64] {
        &self.offset
    }

    /// What each input is then multiplied with.
    pub fn gain(&self) -> &[f64] {
        &self.gain
    }

    /// The outputs y, each between nought and one.
    ///
    /// # Errors
    ///
    /// There are more or fewer inputs than the network has.
    pub fn outputs(&self, inputs: &[f64]) -> Result<Vec<f64>, MlpError> {
        if inputs.len() != self.shape.inputs {
            return Err(MlpError::Length {
                expected: self.shape.inputs,
                found: inputs.len(),
            });
        }
        let scaled: Vec<f64> = inputs
            .iter()
            .zip(&self.offset)
            .zip(&self.gain)
            .map(|((x, offset), gain)| scaled(*x, *offset, *gain))
            .collect();
        let mut hidden = vec![0.0; self.shape.hidden];
        let mut outputs = vec![0.0; self.shape.outputs];
        forward(
            self.shape,
            &self.weights,
            &scaled,
            &mut hidden,
            &mut outputs,
        );
        Ok(outputs)
    }

    /// The class: the output that is largest, the first of equals.
    ///
    /// # Errors
    ///
    /// There are more or fewer inputs than the network has.
    pub fn classify(&self, inputs: &[f64]) -> Result<usize, MlpError> {
        Ok(largest(&self.outputs(inputs)?))
    }

    /// The file of the network, with its numbers as f32: read it with
    /// [`Mlp::parse`] on a module.
    pub fn to_bytes(&self) -> Vec<u8> {
        let Shape {
            inputs,
            hidden,
            outputs,
        } = self.shape;
        write(inputs, hidden, outputs, self.numbers())
    }

    /// All numbers as the file and [`Mlp`] order them.
    fn numbers(&self) -> impl Iterator<Item = f32> {
        let parts = self.shape.parts(&self.weights);
        let scale = self.offset.iter().zip(&self.gain);
        let rows = parts.input.chunks(self.shape.hidden);
        scale
            .zip(rows)
            .flat_map(|((offset, gain), row)| [offset, gain].into_iter().chain(row))
            .chain(parts.hidden_bias)
            .chain(parts.output)
            .chain(parts.output_bias)
            .map(|x| *x as f32)
    }

    /// The network in single precision.
    ///
    /// # Errors
    ///
    /// Its shape is another.
    pub fn single<const I: usize, const H: usize, const O: usize>(
        &self,
    ) -> Result<Mlp<I, H, O>, MlpError> {
        Mlp::copied(&self.to_bytes())
    }
}

/// Index of the largest, the first of equals; of none, nought.
pub(super) fn largest(values: &[f64]) -> usize {
    let mut best = (0, f64::NEG_INFINITY);
    for (at, &value) in values.iter().enumerate() {
        if value > best.1 {
            best = (at, value);
        }
    }
    best.0
}

/// An input as the units see it, limited as on a module.
pub(super) fn scaled(x: f64, offset: f64, gain: f64) -> f64 {
    let limit = f64::from(MAX_SCALED);
    #[allow(clippy::manual_clamp, reason = "these two turn NaN into a number")]
    let z = ((x - offset) * gain).max(-limit).min(limit);
    z
}

/// Hidden and output units from scaled inputs; the slices have the shape's
/// lengths.
pub(super) fn forward(
    shape: Shape,
    weights: &[f64],
    scaled: &[f64],
    hidden: &mut [f64],
    outputs: &mut [f64],
) {
    let parts = shape.parts(weights);
    hidden.copy_from_slice(parts.hidden_bias);
    for (&z, row) in scaled.iter().zip(parts.input.chunks_exact(shape.hidden)) {
        for (drive, &weight) in hidden.iter_mut().zip(row) {
            *drive += weight * z;
        }
    }
    for h in hidden.iter_mut() {
        *h = logistic(*h);
    }
    let rows = parts.output.chunks_exact(shape.hidden);
    for ((y, row), &bias) in outputs.iter_mut().zip(rows).zip(parts.output_bias) {
        let drive: f64 = row.iter().zip(hidden.iter()).map(|(w, h)| w * h).sum();
        *y = logistic(drive + bias);
    }
}

/// σ(u). By libm's exp rather than the system's, which may differ in its last
/// bit from machine to machine: what is trained must not.
pub(super) fn logistic(u: f64) -> f64 {
    1.0 / (1.0 + libm::exp(-u))
}
