//! From a network in f64 to fixed point: as many fraction bits as fit.

use super::{FixedInput, FixedMlp, MAX_BITS, OUTPUT_BITS, SCALED_BITS, hidden_fits, output_fits};
use crate::mlp::{MlpError, Network};

impl Network {
    /// The network in fixed point, for integer inputs.
    ///
    /// # Errors
    ///
    /// Its shape is another, or an input's scale cannot be held.
    pub fn fixed<const I: usize, const H: usize, const O: usize>(
        &self,
    ) -> Result<FixedMlp<I, H, O>, MlpError> {
        FixedMlp::from_network(self)
    }
}

impl<const I: usize, const H: usize, const O: usize> FixedMlp<I, H, O> {
    /// Rounds a network, with as many fraction bits as its sums can bear.
    fn from_network(network: &Network) -> Result<Self, MlpError> {
        let shape = network.shape();
        if (shape.inputs, shape.hidden, shape.outputs) != (I, H, O) {
            return Err(MlpError::Shape {
                inputs: shape.inputs,
                hidden: shape.hidden,
                outputs: shape.outputs,
            });
        }
        let parts = shape.parts(network.weights());
        let mut inputs = [FixedInput {
            offset: 0,
            gain: 0,
            shift: 0,
            weights: [0; H],
        }; I];
        let scales = network.offset().iter().zip(network.gain());
        for (i, (input, (&offset, &gain))) in inputs.iter_mut().zip(scales).enumerate() {
            (input.offset, input.gain, input.shift) =
                fixed_scale(offset, gain).ok_or(MlpError::FixedScale { input: i })?;
        }
        let (hidden_bits, hidden_bias) = (2..=MAX_BITS)
            .rev()
            .find_map(|bits| {
                for (input, row) in inputs.iter_mut().zip(parts.input.chunks(H)) {
                    input.weights = rounded(row, bits)?;
                }
                let bias = rounded(parts.hidden_bias, SCALED_BITS + bits)?;
                hidden_fits(&inputs, &bias).then_some((bits, bias))
            })
            .ok_or(MlpError::Weight)?;
        let mut output = [[0; H]; O];
        let (output_bits, output_bias) = (2..=MAX_BITS)
            .rev()
            .find_map(|bits| {
                for (to, row) in output.iter_mut().zip(parts.output.chunks(H)) {
                    *to = rounded(row, bits)?;
                }
                let bias = rounded(parts.output_bias, OUTPUT_BITS + bits)?;
                output_fits(&output, &bias).then_some((bits, bias))
            })
            .ok_or(MlpError::Weight)?;
        let bits = [hidden_bits, output_bits];
        Self::new(inputs, hidden_bias, output, output_bias, bits)
    }
}

/// Numbers in units of 2^−bits; None if one of them does not fit.
fn rounded<const N: usize, T: TryFrom<i64> + Default + Copy>(
    numbers: &[f64],
    bits: u32,
) -> Option<[T; N]> {
    let mut found = [T::default(); N];
    for (to, x) in found.iter_mut().zip(numbers) {
        // Weights are below 2²⁰, bits below 30.
        *to = T::try_from((x * f64::from(1_u32 << bits)).round() as i64).ok()?;
    }
    Some(found)
}

/// Offset, mantissa and exponent of a scale; None if it cannot be held.
fn fixed_scale(offset: f64, gain: f64) -> Option<(i32, u32, u32)> {
    if gain == 0.0 {
        return Some((0, 0, 0));
    }
    let limits = 2.0_f64.powi(-30)..=2.0_f64.powi(5);
    let fits = offset.abs() < f64::from(i32::MAX);
    if !fits || !limits.contains(&gain) {
        return None;
    }
    let mut mantissa = gain * f64::from(1 << SCALED_BITS);
    let mut shift = 0;
    while mantissa < f64::from(1 << 15) {
        mantissa *= 2.0;
        shift += 1;
    }
    Some((offset.round() as i32, mantissa.round() as u32, shift))
}
