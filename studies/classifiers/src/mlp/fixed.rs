//! A network in fixed point, for parts without an FPU: 16-bit weights, 32-bit
//! sums that cannot overflow, integer inputs.
//!
//! Weights have 16 bits and not 8. With 8 an output is off by 0.03 rather than
//! 0.003 (measured on networks of the papers' sizes; hit rates were the same to
//! 0.1 %), while a multiplication takes as long, and the larger of the papers'
//! networks has 5 KB of weights at 16 bits, half of what f32 needs.

#[cfg(feature = "train")]
mod rounding;

use super::error::MlpError;
use super::format::check_shape;
use super::logistic::{DRIVE_BITS, OUTPUT_BITS, logistic_fixed};

/// Fraction bits of a scaled input.
const SCALED_BITS: u32 = 10;
/// Largest scaled input: 32 standard deviations.
const MAX_SCALED: i64 = 1 << 15;
/// Most fraction bits of a weight.
const MAX_BITS: u32 = 14;
/// Most places by which a scaled input is shifted.
const MAX_SHIFT: u32 = 35;

/// One input: its scale, and its weight in each of H hidden units.
/// z = ((x − offset) · gain) / 2^shift, in units of 2⁻¹⁰.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FixedInput<const H: usize> {
    /// The input's mean in training, in its unit.
    pub offset: i32,
    /// Mantissa of 2¹⁰ over the standard deviation in training: 0 to 2¹⁶.
    pub gain: u32,
    /// Its exponent, 0 to 35.
    pub shift: u32,
    /// W_ij for all j, in units of 2 to the minus weight bits.
    pub weights: [i16; H],
}

/// A trained network in fixed point: an immutable configuration of
/// I (12 + 2 H) + 4 H + O (2 H + 4) + 8 bytes, two an input more where H is odd.
///
/// Scaled inputs are limited to ±32 standard deviations and rounded down to
/// 2⁻¹⁰ of one; outputs are then within 3e-3 of the f64 network's for trained
/// networks of the papers' sizes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FixedMlp<const I: usize, const H: usize, const O: usize> {
    inputs: [FixedInput<H>; I],
    hidden_bias: [i32; H],
    output: [[i16; H]; O],
    output_bias: [i32; O],
    /// From a hidden unit's sum to a drive.
    hidden_shift: u32,
    /// From an output's sum to a drive.
    output_shift: u32,
}

/// The sums of the hidden units so far, and how many inputs they hold.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FixedMlpState<const H: usize> {
    sums: [i32; H],
    next: usize,
}

impl<const I: usize, const H: usize, const O: usize> FixedMlp<I, H, O> {
    /// A network of its numbers; `const`, so it can be a `static`. Biases are
    /// in the units of the sums: 2 to the minus (10 + weight bits) for hidden
    /// units, 2 to the minus (15 + weight bits) for outputs. `bits` are the
    /// weights' fraction bits, of inputs and of outputs, 2 to 14.
    ///
    /// # Errors
    ///
    /// The shape, the bits or a scale is outside the limits, or some inputs
    /// could overflow a sum ([`MlpError::Weight`]).
    pub const fn new(
        inputs: [FixedInput<H>; I],
        hidden_bias: [i32; H],
        output: [[i16; H]; O],
        output_bias: [i32; O],
        bits: [u32; 2],
    ) -> Result<Self, MlpError> {
        if let Err(error) = check_shape(I, H, O) {
            return Err(error);
        }
        if bits[0] < 2 || bits[0] > MAX_BITS || bits[1] < 2 || bits[1] > MAX_BITS {
            return Err(MlpError::Weight);
        }
        let mut i = 0;
        while i < I {
            if inputs[i].gain > 1 << 16 || inputs[i].shift > MAX_SHIFT {
                return Err(MlpError::FixedScale { input: i });
            }
            i += 1;
        }
        if !hidden_fits(&inputs, &hidden_bias) || !output_fits(&output, &output_bias) {
            return Err(MlpError::Weight);
        }
        Ok(Self {
            inputs,
            hidden_bias,
            output,
            output_bias,
            hidden_shift: SCALED_BITS + bits[0] - DRIVE_BITS,
            output_shift: OUTPUT_BITS + bits[1] - DRIVE_BITS,
        })
    }

    /// The state before the first input.
    #[inline]
    pub fn state(&self) -> FixedMlpState<H> {
        FixedMlpState {
            sums: self.hidden_bias,
            next: 0,
        }
    }

    /// Takes the next input, of any value. The last of the I gives the class,
    /// and the state is then as new.
    #[inline]
    pub fn push(&self, state: &mut FixedMlpState<H>, input: i32) -> Option<usize> {
        self.take(state, input).map(|sums| {
            let mut best = 0;
            let mut highest = i32::MIN;
            for (k, &sum) in sums.iter().enumerate() {
                if sum > highest {
                    highest = sum;
                    best = k;
                }
            }
            best
        })
    }

    /// As [`push`](Self::push), but the last input gives all outputs y in units
    /// of 2⁻¹⁵.
    #[inline]
    pub fn push_for_outputs(&self, state: &mut FixedMlpState<H>, input: i32) -> Option<[i32; O]> {
        self.take(state, input)
            .map(|sums| sums.map(|sum| logistic_fixed(sum >> self.output_shift)))
    }

    /// Forgets the inputs so far.
    #[inline]
    pub fn reset(&self, state: &mut FixedMlpState<H>) {
        *state = self.state();
    }

    /// Classifies a whole row of inputs at once.
    pub fn classify(&self, inputs: &[i32; I]) -> usize {
        let mut state = self.state();
        let mut class = 0;
        for &x in inputs {
            // It comes with the last input alone.
            if let Some(found) = self.push(&mut state, x) {
                class = found;
            }
        }
        class
    }

    /// The sums of the outputs, after the last input.
    #[inline]
    fn take(&self, state: &mut FixedMlpState<H>, x: i32) -> Option<[i32; O]> {
        // There always is one: the state goes back to the first after the last.
        let input = self.inputs.get(state.next)?;
        // Below 2³² times 2¹⁶.
        let z = ((i64::from(x) - i64::from(input.offset)) * i64::from(input.gain)) >> input.shift;
        let z = z.clamp(-MAX_SCALED, MAX_SCALED) as i32;
        for (sum, &weight) in state.sums.iter_mut().zip(&input.weights) {
            *sum += i32::from(weight) * z;
        }
        state.next += 1;
        if state.next < I {
            return None;
        }
        Some(self.end(state))
    }

    #[inline(never)]
    fn end(&self, state: &mut FixedMlpState<H>) -> [i32; O] {
        let hidden = state
            .sums
            .map(|sum| logistic_fixed(sum >> self.hidden_shift));
        self.reset(state);
        let mut sums = self.output_bias;
        for (sum, weights) in sums.iter_mut().zip(&self.output) {
            for (&weight, &h) in weights.iter().zip(&hidden) {
                *sum += i32::from(weight) * h;
            }
        }
        sums
    }
}

/// Whether no inputs can overflow a hidden unit's sum: all at the limit 2¹⁵.
const fn hidden_fits<const I: usize, const H: usize>(
    inputs: &[FixedInput<H>; I],
    bias: &[i32; H],
) -> bool {
    let mut j = 0;
    while j < H {
        let mut sum = bias[j].unsigned_abs() as u64;
        let mut i = 0;
        while i < I {
            sum += (inputs[i].weights[j].unsigned_abs() as u64) << 15;
            i += 1;
        }
        if sum > i32::MAX as u64 {
            return false;
        }
        j += 1;
    }
    true
}

/// Whether no hidden units can overflow an output's sum: all at one.
const fn output_fits<const H: usize, const O: usize>(
    weights: &[[i16; H]; O],
    bias: &[i32; O],
) -> bool {
    let mut k = 0;
    while k < O {
        let mut sum = bias[k].unsigned_abs() as u64;
        let mut j = 0;
        while j < H {
            sum += (weights[k][j].unsigned_abs() as u64) << OUTPUT_BITS;
            j += 1;
        }
        if sum > i32::MAX as u64 {
            return false;
        }
        k += 1;
    }
    true
}
