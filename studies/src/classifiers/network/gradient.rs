//! The cost of a network on a training set, and its gradient by back-propagation.
//!
//! The products are written out rather than left to a matrix library: those choose their
//! instructions by the processor they meet, fuse or do not fuse multiplication and addition, and
//! so train another network on another machine. Here the same seed gives the same bits everywhere.

use super::{Shape, forward};

/// Scaled inputs and classes of some samples.
#[derive(Debug, Clone, Default)]
pub(super) struct Samples {
    /// The inputs of a sample together.
    pub(super) inputs: Vec<f64>,
    pub(super) classes: Vec<usize>,
}

/// E = 1/(2 N) Σ_n Σ_k (y_k − t_k)² + λ/2 Σ w², t_k being one for the sample's class and nought
/// for the others; the sum of squares that LEP12 section 5.2 takes the root of. λ weighs all
/// weights but no biases.
pub(super) fn cost(shape: Shape, weights: &[f64], samples: &Samples, decay: f64) -> f64 {
    cost_and_gradient(shape, weights, samples, decay, None)
}

/// The cost, and its gradient into `gradient`, which has a place for each weight.
pub(super) fn cost_and_gradient(
    shape: Shape,
    weights: &[f64],
    samples: &Samples,
    decay: f64,
    mut gradient: Option<&mut [f64]>,
) -> f64 {
    let mut hidden = vec![0.0; shape.hidden];
    let mut outputs = vec![0.0; shape.outputs];
    let mut sum = 0.0;
    let rows = samples.inputs.chunks_exact(shape.inputs);
    for (inputs, &class) in rows.zip(&samples.classes) {
        forward(shape, weights, inputs, &mut hidden, &mut outputs);
        let target = |k| if k == class { 1.0 } else { 0.0 };
        let errors = outputs.iter().enumerate().map(|(k, y)| y - target(k));
        let errors: Vec<f64> = errors.collect();
        sum = errors.iter().fold(sum, |sum, error| sum + error * error);
        if let Some(gradient) = &mut gradient {
            // σ′ = σ (1 − σ).
            let deltas = errors.iter().zip(&outputs).map(|(e, y)| e * y * (1.0 - y));
            let deltas: Vec<f64> = deltas.collect();
            add_slopes(shape, weights, inputs, &hidden, &deltas, gradient);
        }
    }
    let scale = 1.0 / samples.classes.len().max(1) as f64;
    let [input, hidden_bias, output] = shape.ends();
    let penalised = [0..input, hidden_bias..output];
    if let Some(gradient) = gradient {
        for slope in gradient.iter_mut() {
            *slope *= scale;
        }
        for range in penalised.clone() {
            for (slope, weight) in gradient[range.clone()].iter_mut().zip(&weights[range]) {
                *slope += decay * weight;
            }
        }
    }
    let squares = penalised.into_iter().flat_map(|range| &weights[range]);
    let squares: f64 = squares.map(|w| w * w).sum();
    0.5 * sum * scale + 0.5 * decay * squares
}

/// Adds a sample's part of the gradient: `deltas` are ∂cost/∂drive of the outputs.
fn add_slopes(
    shape: Shape,
    weights: &[f64],
    inputs: &[f64],
    hidden: &[f64],
    deltas: &[f64],
    gradient: &mut [f64],
) {
    let [input, hidden_bias, output] = shape.ends();
    let (to_input, rest) = gradient.split_at_mut(input);
    let (to_hidden_bias, rest) = rest.split_at_mut(shape.hidden);
    let (to_output, to_output_bias) = rest.split_at_mut(output - hidden_bias);
    let mut blame = vec![0.0; shape.hidden];
    for (k, &delta) in deltas.iter().enumerate() {
        let row = k * shape.hidden..(k + 1) * shape.hidden;
        let of_output = &weights[hidden_bias..output][row.clone()];
        let to_weights = &mut to_output[row];
        for (j, h) in hidden.iter().enumerate() {
            to_weights[j] += delta * h;
            blame[j] += delta * of_output[j];
        }
        to_output_bias[k] += delta;
    }
    for ((blame, h), to_bias) in blame.iter_mut().zip(hidden).zip(to_hidden_bias) {
        *blame *= h * (1.0 - h);
        *to_bias += *blame;
    }
    for (&z, row) in inputs.iter().zip(to_input.chunks_exact_mut(shape.hidden)) {
        for (to_weight, &blame) in row.iter_mut().zip(&blame) {
            *to_weight += blame * z;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Samples, Shape, cost, cost_and_gradient};

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
            let mut gradient = vec![0.0; shape.weights()];
            let all = Some(&mut gradient[..]);
            let value = cost_and_gradient(shape, &weights, &samples, decay, all);
            assert_eq!(value, cost(shape, &weights, &samples, decay));
            for i in 0..weights.len() {
                let at = weights[i];
                let mut beside = |h: f64| {
                    weights[i] = at + h;
                    cost(shape, &weights, &samples, decay)
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
