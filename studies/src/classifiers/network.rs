//! A feed-forward network with one hidden layer.
//!
//! # Glossary
//!
//! - **input**: one number of what is to be classified: the power in one band of a spectrum (LEP12
//!   section 5.2: 120 of them), the IMP of one vibrissa (PSIK section 3.2.1: 33).
//! - **scaled input**: z = (x − offset) · gain, with mean nought and variance one over the training
//!   set.
//! - **drive**: what a unit sums up before its transfer function.
//! - **log-sigmoid**: σ(u) = 1 / (1 + exp(−u)), the transfer function of every hidden and output
//!   unit.
//!
//! # Equations
//!
//! h_j = σ(b_j + Σ_i W_ij z_i) for the H hidden units, y_k = σ(c_k + Σ_j V_kj h_j) for the O
//! outputs, and the class is the k of the largest y_k, the first of equals.
//!
//! Products are written out rather than left to a matrix library: those choose their instructions
//! by the processor they meet, fuse or do not fuse multiplication and addition, and so train
//! another network on another machine. Here the same seed gives the same bits everywhere.

use anyhow::{Result, ensure};
mod train;

pub(crate) use train::{Options, Row, train};

/// Largest scaled input, standard deviations; what lies beyond counts as this.
const MAX_SCALED: f64 = 1024.0;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Shape {
    inputs: usize,
    hidden: usize,
    outputs: usize,
}

impl Shape {
    /// Weights and biases: I H + H + O H + O. They stand in this order: for each input its H
    /// weights, the H biases, for each output its H weights, the O biases.
    const fn weights(self) -> usize {
        (self.inputs + 1) * self.hidden + (self.hidden + 1) * self.outputs
    }

    const fn ends(self) -> [usize; 3] {
        let input = self.inputs * self.hidden;
        let hidden_bias = input + self.hidden;
        [input, hidden_bias, hidden_bias + self.outputs * self.hidden]
    }
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Network {
    shape: Shape,
    /// Offset and gain of each input; a gain of nought for one that was constant in training.
    scales: Vec<(f64, f64)>,
    /// In the order of [`Shape::weights`].
    weights: Vec<f64>,
}

impl Network {
    /// The outputs y, each between nought and one.
    fn outputs(&self, inputs: &[f64]) -> Result<Vec<f64>> {
        let (found, needed) = (inputs.len(), self.shape.inputs);
        ensure!(found == needed, "{found} inputs for a network of {needed}");
        let mut hidden = vec![0.0; self.shape.hidden];
        let mut outputs = vec![0.0; self.shape.outputs];
        let z = scaled(inputs, &self.scales);
        forward(self.shape, &self.weights, &z, &mut hidden, &mut outputs);
        Ok(outputs)
    }

    pub(crate) fn classify(&self, inputs: &[f64]) -> Result<usize> {
        Ok(largest(&self.outputs(inputs)?))
    }
}

/// The place of the largest, the first of equals.
pub(crate) fn largest<T: PartialOrd>(all: &[T]) -> usize {
    (1..all.len()).fold(0, |best, k| if all[k] > all[best] { k } else { best })
}

fn scaled(inputs: &[f64], scales: &[(f64, f64)]) -> Vec<f64> {
    let one = |(x, (offset, gain)): (&f64, &(f64, f64))| {
        ((x - offset) * gain).clamp(-MAX_SCALED, MAX_SCALED)
    };
    inputs.iter().zip(scales).map(one).collect()
}

/// Hidden and output units from scaled inputs; the slices have the shape's lengths.
fn forward(shape: Shape, weights: &[f64], scaled: &[f64], hidden: &mut [f64], outputs: &mut [f64]) {
    let [input, hidden_bias, output] = shape.ends();
    hidden.copy_from_slice(&weights[input..hidden_bias]);
    let rows = weights[..input].chunks_exact(shape.hidden);
    for (&z, row) in scaled.iter().zip(rows) {
        for (drive, &weight) in hidden.iter_mut().zip(row) {
            *drive += weight * z;
        }
    }
    for h in hidden.iter_mut() {
        *h = logistic(*h);
    }
    let rows = weights[hidden_bias..output].chunks_exact(shape.hidden);
    for ((y, row), &bias) in outputs.iter_mut().zip(rows).zip(&weights[output..]) {
        let drive: f64 = row.iter().zip(hidden.iter()).map(|(w, h)| w * h).sum();
        *y = logistic(drive + bias);
    }
}

/// σ(u). By libm's exp rather than the system's, which may differ in its last bit from machine to
/// machine: what is trained must not.
fn logistic(u: f64) -> f64 {
    1.0 / (1.0 + libm::exp(-u))
}

/// Scaled inputs and classes of some samples.
#[derive(Debug, Clone, Default)]
struct Samples {
    /// The inputs of a sample together.
    inputs: Vec<f64>,
    classes: Vec<usize>,
}

/// E = 1/(2 N) Σ_n Σ_k (y_k − t_k)² + λ/2 Σ w², t_k being one for the sample's class and nought
/// for the others; the sum of squares that LEP12 section 5.2 takes the root of. λ weighs all
/// weights but no biases. And its gradient, a number a weight.
fn cost_and_gradient(
    shape: Shape,
    weights: &[f64],
    samples: &Samples,
    decay: f64,
) -> (f64, Vec<f64>) {
    let [input, hidden_bias, output] = shape.ends();
    let mut gradient = vec![0.0; weights.len()];
    let (to_input, rest) = gradient.split_at_mut(input);
    let (to_hidden_bias, rest) = rest.split_at_mut(shape.hidden);
    let (to_output, to_output_bias) = rest.split_at_mut(output - hidden_bias);
    let mut hidden = vec![0.0; shape.hidden];
    let mut outputs = vec![0.0; shape.outputs];
    let mut sum = 0.0;
    let rows = samples.inputs.chunks_exact(shape.inputs);
    for (inputs, &class) in rows.zip(&samples.classes) {
        forward(shape, weights, inputs, &mut hidden, &mut outputs);
        let mut blame = vec![0.0; shape.hidden];
        for (k, y) in outputs.iter().enumerate() {
            let error = y - if k == class { 1.0 } else { 0.0 };
            sum += error * error;
            // σ′ = σ (1 − σ).
            let delta = error * y * (1.0 - y);
            for (j, h) in hidden.iter().enumerate() {
                let place = k * shape.hidden + j;
                to_output[place] += delta * h;
                blame[j] += delta * weights[hidden_bias + place];
            }
            to_output_bias[k] += delta;
        }
        for ((blame, h), to_bias) in blame.iter_mut().zip(&hidden).zip(&mut *to_hidden_bias) {
            *blame *= h * (1.0 - h);
            *to_bias += *blame;
        }
        for (&z, row) in inputs.iter().zip(to_input.chunks_exact_mut(shape.hidden)) {
            for (to_weight, &blame) in row.iter_mut().zip(&blame) {
                *to_weight += blame * z;
            }
        }
    }
    let scale = 1.0 / samples.classes.len().max(1) as f64;
    for slope in &mut gradient {
        *slope *= scale;
    }
    let mut squares = 0.0;
    for place in (0..input).chain(hidden_bias..output) {
        gradient[place] += decay * weights[place];
        squares += weights[place] * weights[place];
    }
    (0.5 * sum * scale + 0.5 * decay * squares, gradient)
}

#[cfg(test)]
mod tests {
    use super::{Network, Samples, Shape, cost_and_gradient};

    /// The networks of reference/network.py, which printed the outputs.
    #[test]
    fn outputs_are_those_of_numpy() {
        let cases: [([usize; 3], &[f64]); 2] = [
            ([3, 4, 2], &[0.445_601_673_135_956_6, 0.512_941_465_174_771]),
            (
                [7, 5, 3],
                &[
                    0.319_570_670_528_236_5,
                    0.090_202_885_384_679_35,
                    0.445_314_661_141_623_2,
                ],
            ),
        ];
        for ([inputs, hidden, outputs], exact) in cases {
            let shape = Shape {
                inputs,
                hidden,
                outputs,
            };
            let sines = |count: usize, f: fn(f64) -> f64| (0..count).map(move |i| f(i as f64));
            let gains = sines(inputs, |i| 1.0 + 0.5 * (0.7 * i).sin());
            let network = Network {
                shape,
                scales: sines(inputs, |i| (0.3 * i).sin()).zip(gains).collect(),
                weights: sines(shape.weights(), |i| 1.5 * (1.0 + i).sin()).collect(),
            };
            let x: Vec<f64> = sines(inputs, |i| 2.0 * (0.9 * i + 0.2).sin()).collect();
            let found = network.outputs(&x).unwrap();
            assert_eq!(found.len(), exact.len());
            for (y, exact) in found.iter().zip(exact) {
                assert!((y - exact).abs() < 1e-14, "{y} {exact}");
            }
            assert!(network.classify(&x[1..]).is_err());
        }
    }

    /// Numbers in −1 to 1 without any order.
    fn numbers(count: usize, from: u32) -> Vec<f64> {
        let spread = |i| u32::wrapping_mul(i, 0x9E37_79B9) as i32;
        let number = |i| f64::from(spread(i)) / 2_147_483_648.0;
        (from..).take(count).map(number).collect()
    }

    #[test]
    fn the_gradient_is_that_of_finite_differences() {
        let shape = Shape {
            inputs: 5,
            hidden: 4,
            outputs: 3,
        };
        let samples = Samples {
            inputs: numbers(35, 1),
            classes: vec![0, 1, 2, 2, 1, 0, 2],
        };
        for decay in [0.0, 0.3] {
            let mut weights = numbers(shape.weights(), 1000);
            let (_, gradient) = cost_and_gradient(shape, &weights, &samples, decay);
            for i in 0..weights.len() {
                let at = weights[i];
                let mut beside = |h: f64| {
                    weights[i] = at + h;
                    cost_and_gradient(shape, &weights, &samples, decay).0
                };
                // Fourth order: the rest is below 1e-12 for such smooth functions.
                let h = 1e-3;
                let far = beside(2.0 * h) - beside(-2.0 * h);
                let slope = (8.0 * (beside(h) - beside(-h)) - far) / (12.0 * h);
                weights[i] = at;
                assert!((gradient[i] - slope).abs() < 1e-11, "{i}: {slope}");
            }
        }
    }
}
