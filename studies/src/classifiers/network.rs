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

use anyhow::{Result, ensure};
mod gradient;
mod session;
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
        let scaled = scaled(inputs, &self.scales);
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
    pub(crate) fn classify(&self, inputs: &[f64]) -> Result<usize> {
        let outputs = self.outputs(inputs)?;
        let places = 1..outputs.len();
        let larger = |best: usize, k: usize| if outputs[k] > outputs[best] { k } else { best };
        Ok(places.fold(0, larger))
    }
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
    for (&z, row) in scaled
        .iter()
        .zip(weights[..input].chunks_exact(shape.hidden))
    {
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

#[cfg(test)]
mod tests {
    use super::{Network, Shape};

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
}
