//! The cost of a network on a training set, and its gradient by
//! back-propagation.
//!
//! The products are written out rather than left to a matrix library: those
//! choose their instructions by the processor they meet, fuse or do not fuse
//! multiplication and addition, and so train another network on another
//! machine. Here the same seed gives the same bits everywhere.

use std::vec;
use std::vec::Vec;

use super::network::forward;
use super::shape::Shape;

/// Scaled inputs and classes of some samples.
#[derive(Debug, Clone, Default)]
pub(super) struct Samples {
    /// The inputs of a sample together.
    pub(super) inputs: Vec<f64>,
    pub(super) classes: Vec<u16>,
}

impl Samples {
    fn rows(&self, shape: Shape) -> impl Iterator<Item = (&[f64], usize)> {
        let classes = self.classes.iter().map(|&c| usize::from(c));
        self.inputs.chunks_exact(shape.inputs).zip(classes)
    }
}

/// Room for the units of one sample.
struct Units {
    hidden: Vec<f64>,
    outputs: Vec<f64>,
    /// −∂cost/∂drive of the hidden units.
    blame: Vec<f64>,
}

impl Units {
    fn new(shape: Shape) -> Self {
        Self {
            hidden: vec![0.0; shape.hidden],
            outputs: vec![0.0; shape.outputs],
            blame: vec![0.0; shape.hidden],
        }
    }

    fn compute(&mut self, shape: Shape, weights: &[f64], inputs: &[f64]) {
        let Self {
            hidden, outputs, ..
        } = self;
        forward(shape, weights, inputs, hidden, outputs);
    }
}

/// E = 1/(2 N) Σ_n Σ_k (y_k − t_k)² + λ/2 Σ w², t_k being one for the sample's
/// class and nought for the others; the sum of squares that LEP12 section 5.2
/// takes the root of. λ weighs all weights but no biases.
pub(super) fn cost(shape: Shape, weights: &[f64], samples: &Samples, decay: f64) -> f64 {
    let mut units = Units::new(shape);
    let mut sum = 0.0;
    for (inputs, class) in samples.rows(shape) {
        units.compute(shape, weights, inputs);
        for (k, y) in units.outputs.iter().enumerate() {
            let error = y - if k == class { 1.0 } else { 0.0 };
            sum += error * error;
        }
    }
    0.5 * sum / count(samples) + penalty(shape, weights, decay)
}

/// The cost, and its gradient into `gradient`, which has a place for each
/// weight.
pub(super) fn cost_and_gradient(
    shape: Shape,
    weights: &[f64],
    samples: &Samples,
    decay: f64,
    gradient: &mut [f64],
) -> f64 {
    gradient.fill(0.0);
    let mut units = Units::new(shape);
    let mut sum = 0.0;
    let output = shape.parts(weights).output;
    let (to_input, rest) = gradient.split_at_mut(shape.inputs * shape.hidden);
    let (to_hidden_bias, rest) = rest.split_at_mut(shape.hidden);
    let (to_output, to_output_bias) = rest.split_at_mut(shape.outputs * shape.hidden);
    for (inputs, class) in samples.rows(shape) {
        units.compute(shape, weights, inputs);
        units.blame.fill(0.0);
        for (k, y) in units.outputs.iter().enumerate() {
            let error = y - if k == class { 1.0 } else { 0.0 };
            sum += error * error;
            // σ′ = σ (1 − σ).
            let delta = error * y * (1.0 - y);
            let row = k * shape.hidden..(k + 1) * shape.hidden;
            let (weights, to_weights) = (&output[row.clone()], &mut to_output[row]);
            for (j, h) in units.hidden.iter().enumerate() {
                to_weights[j] += delta * h;
                units.blame[j] += delta * weights[j];
            }
            to_output_bias[k] += delta;
        }
        for ((blame, h), to_bias) in units
            .blame
            .iter_mut()
            .zip(&units.hidden)
            .zip(to_hidden_bias.iter_mut())
        {
            *blame *= h * (1.0 - h);
            *to_bias += *blame;
        }
        for (&z, row) in inputs.iter().zip(to_input.chunks_exact_mut(shape.hidden)) {
            for (to_weight, &blame) in row.iter_mut().zip(&units.blame) {
                *to_weight += blame * z;
            }
        }
    }
    let scale = 1.0 / count(samples);
    for slope in gradient.iter_mut() {
        *slope *= scale;
    }
    if decay > 0.0 {
        for range in penalised(shape) {
            for (slope, weight) in gradient[range.clone()].iter_mut().zip(&weights[range]) {
                *slope += decay * weight;
            }
        }
    }
    0.5 * sum * scale + penalty(shape, weights, decay)
}

fn count(samples: &Samples) -> f64 {
    samples.classes.len().max(1) as f64
}

/// Where the weights stand that are no biases.
fn penalised(shape: Shape) -> [core::ops::Range<usize>; 2] {
    let input = shape.inputs * shape.hidden;
    let output = input + shape.hidden;
    [0..input, output..output + shape.outputs * shape.hidden]
}

fn penalty(shape: Shape, weights: &[f64], decay: f64) -> f64 {
    if decay == 0.0 {
        return 0.0;
    }
    let squares: f64 = penalised(shape)
        .into_iter()
        .flat_map(|range| &weights[range])
        .map(|w| w * w)
        .sum();
    0.5 * decay * squares
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers in −1 to 1 without any order.
    fn numbers(count: usize, from: u32) -> Vec<f64> {
        let spread = |i| u32::wrapping_mul(i, 0x9E37_79B9) as i32;
        (from..)
            .take(count)
            .map(|i| f64::from(spread(i)) / 2_147_483_648.0)
            .collect()
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
            let mut gradient = vec![f64::NAN; shape.weights()];
            let value = cost_and_gradient(shape, &weights, &samples, decay, &mut gradient);
            assert!((value - cost(shape, &weights, &samples, decay)).abs() < 1e-15);
            for i in 0..weights.len() {
                let at = weights[i];
                let mut beside = |h: f64| {
                    weights[i] = at + h;
                    cost(shape, &weights, &samples, decay)
                };
                // Fourth order: the rest is below 1e-12 for such smooth functions.
                let h = 1e-3;
                let slope = (8.0 * (beside(h) - beside(-h)) - (beside(2.0 * h) - beside(-2.0 * h)))
                    / (12.0 * h);
                weights[i] = at;
                assert!(
                    (gradient[i] - slope).abs() < 1e-11,
                    "{i}: {} {slope}",
                    gradient[i]
                );
            }
        }
    }
}
