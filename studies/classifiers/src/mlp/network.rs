//! A network of any shape in f64: what training yields, what experiments run,
//! and what the embedded form is made from.

use std::vec;
use std::vec::Vec;

use super::shape::Shape;
use super::single::{Mlp, MlpInput};
use crate::error::Error;
use crate::limits::{MAX_SCALED, MAX_WEIGHT};

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
    pub fn new(shape: Shape, offset: &[f64], gain: &[f64], weights: &[f64]) -> Result<Self, Error> {
        shape.check()?;
        for (expected, found) in [
            (shape.inputs, offset.len()),
            (shape.inputs, gain.len()),
            (shape.weights(), weights.len()),
        ] {
            if expected != found {
                return Err(Error::Length { expected, found });
            }
        }
        // As f32 they must be finite too.
        let usable = |x: &f64| (*x as f32).is_finite();
        let scales = offset.iter().zip(gain);
        if let Some(input) = scales.clone().position(|(o, g)| !usable(o) || !usable(g)) {
            return Err(Error::Scale { input });
        }
        if !weights.iter().all(|w| w.abs() <= f64::from(MAX_WEIGHT)) {
            return Err(Error::Weight);
        }
        Ok(Self {
            shape,
            offset: offset.to_vec(),
            gain: gain.to_vec(),
            weights: weights.to_vec(),
        })
    }

    /// The weights, in the order of [`Shape::weights`].
    pub fn weights(&self) -> &[f64] {
        &self.weights
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
    pub fn outputs(&self, inputs: &[f64]) -> Result<Vec<f64>, Error> {
        if inputs.len() != self.shape.inputs {
            return Err(Error::Length {
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
    pub fn classify(&self, inputs: &[f64]) -> Result<usize, Error> {
        Ok(largest(&self.outputs(inputs)?))
    }

    /// The network in single precision.
    ///
    /// # Errors
    ///
    /// Its shape is another.
    pub fn single<const I: usize, const H: usize, const O: usize>(
        &self,
    ) -> Result<Mlp<I, H, O>, Error> {
        let Shape {
            inputs,
            hidden,
            outputs,
        } = self.shape;
        for (expected, found) in [(I, inputs), (H, hidden), (O, outputs)] {
            if expected != found {
                return Err(Error::Length { expected, found });
            }
        }
        let parts = self.shape.parts(&self.weights);
        let row = |row: &[f64]| core::array::from_fn(|j| row[j] as f32);
        Mlp::new(
            core::array::from_fn(|i| MlpInput {
                offset: self.offset[i] as f32,
                gain: self.gain[i] as f32,
                weights: row(&parts.input[i * H..]),
            }),
            row(parts.hidden_bias),
            core::array::from_fn(|k| row(&parts.output[k * H..])),
            core::array::from_fn(|k| parts.output_bias[k] as f32),
        )
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
