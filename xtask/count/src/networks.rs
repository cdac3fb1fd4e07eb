//! Networks of the papers' shapes, with weights of no meaning: how many
//! instructions they take does not depend on them.

use classifiers::mlp::{Mlp, MlpInput, MlpState};

/// A number from −1 to 1 without any order.
const fn weight(at: usize) -> f32 {
    let spread = (at as u32).wrapping_add(1).wrapping_mul(0x9E37_79B9) as i32;
    (spread >> 8) as f32 / 8_388_608.0
}

const fn row<const H: usize>(from: usize) -> [f32; H] {
    let mut row = [0.0; H];
    let mut j = 0;
    while j < H {
        row[j] = weight(from + j);
        j += 1;
    }
    row
}

/// A network in single precision.
///
/// # Panics
/// If there can be none of this shape.
pub const fn single<const I: usize, const H: usize, const O: usize>() -> Mlp<I, H, O> {
    let mut inputs = [MlpInput {
        offset: 500.0,
        gain: 0.002,
        weights: [0.0; H],
    }; I];
    let mut i = 0;
    while i < I {
        inputs[i].weights = row(i * H);
        i += 1;
    }
    let mut output = [[0.0; H]; O];
    let mut k = 0;
    while k < O {
        output[k] = row(k * H + 7);
        k += 1;
    }
    match Mlp::new(inputs, row(3), output, row(5)) {
        Ok(network) => network,
        Err(_) => panic!("a shape of a network"),
    }
}

/// A network in single precision, and its inputs so far.
#[derive(Debug)]
pub struct Single<const I: usize, const H: usize, const O: usize> {
    network: &'static Mlp<I, H, O>,
    state: MlpState<H>,
}

impl<const I: usize, const H: usize, const O: usize> Single<I, H, O> {
    /// Before the first input.
    pub fn new(network: &'static Mlp<I, H, O>) -> Self {
        let state = network.state();
        Self { network, state }
    }

    /// The class, after the last input of a row; 0 after others.
    #[inline]
    pub fn push(&mut self, input: f32) -> u32 {
        let class = self.network.push(&mut self.state, input);
        class.map_or(0, |class| class as u32)
    }
}
