//! H50: the third-order Butterworth low-pass of BIOTACT eq. 5 and 9, as one
//! direct difference equation.

use std::f64::consts::PI;

/// The bilinear transform of the analogue third-order Butterworth low-pass,
/// pre-warped at its cutoff, at rest initially:
/// y(n) = Σ b_k x(n − k) − Σ a_k y(n − k).
#[derive(Clone, Debug)]
pub(crate) struct Lowpass {
    /// Feed-forward coefficients b_0 to b_3.
    pub(crate) b: [f64; 4],
    /// Feedback coefficients a_1 to a_3 (a_0 = 1).
    pub(crate) a: [f64; 3],
    inputs: [f64; 3],
    outputs: [f64; 3],
}

impl Lowpass {
    /// Designs the filter from the analogue poles −Ω and Ω exp(±j 2π/3), where
    /// Ω T/2 = tan(π `cutoff_hz`/`tick_hz`); `cutoff_hz` lies below half of
    /// `tick_hz`.
    pub(crate) fn new(cutoff_hz: f64, tick_hz: f64) -> Self {
        // s T/2 of the poles; the transform is z = (1 + sT/2)/(1 − sT/2).
        let warped = (PI * cutoff_hz / tick_hz).tan();
        let real_pole = (1.0 - warped) / (1.0 + warped);
        let (re, im) = (
            warped * (2.0 * PI / 3.0).cos(),
            warped * (2.0 * PI / 3.0).sin(),
        );
        let below = (1.0 - re) * (1.0 - re) + im * im;
        let pair_re = (1.0 - re * re - im * im) / below;
        let pair_im = 2.0 * im / below;
        let pair_square = pair_re * pair_re + pair_im * pair_im;
        // (1 − p z⁻¹)(1 − 2 Re(q) z⁻¹ + |q|² z⁻²), multiplied out.
        let a = [
            -real_pole - 2.0 * pair_re,
            pair_square + 2.0 * real_pole * pair_re,
            -real_pole * pair_square,
        ];
        // Three zeros at z = −1, scaled to unit gain at z = 1.
        let unit = (1.0 - real_pole) * (1.0 - 2.0 * pair_re + pair_square) / 8.0;
        Self {
            b: [unit, 3.0 * unit, 3.0 * unit, unit],
            a,
            inputs: [0.0; 3],
            outputs: [0.0; 3],
        }
    }

    pub(crate) fn step(&mut self, x: f64) -> f64 {
        let [x1, x2, x3] = self.inputs;
        let [y1, y2, y3] = self.outputs;
        let y = self.b[0] * x + self.b[1] * x1 + self.b[2] * x2 + self.b[3] * x3
            - self.a[0] * y1
            - self.a[1] * y2
            - self.a[2] * y3;
        self.inputs = [x, x1, x2];
        self.outputs = [y, y1, y2];
        y
    }
}
