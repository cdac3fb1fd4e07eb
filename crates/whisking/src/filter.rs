//! H50: the third-order low-pass Butterworth filter that smooths contact
//! signals and oscillator noise (BIOTACT sections III-B and III-C).
//!
//! A first-order section and a second-order one with damping k = 1, both in
//! trapezoidal state-variable form with g = tan(π f_c T). That is exactly the
//! bilinear transform pre-warped at f_c, but the coefficients stay well scaled
//! at any tick rate; those of a direct form crowd around 1 and 2, which costs
//! single precision three digits.
//!
//! The second-order section in full, with a = 1/(1 + g + g²) and v₃ its input
//! minus s₂: v₁ = a (s₁ + g v₃), v₂ = s₂ + g v₁, s₁ and s₂ change by twice
//! (v₁ − s₁) and (v₂ − s₂). With the inner state kept as p = g s₁/2, the increment
//! g v₁ is 2 a p + g² a v₃, which is p plus the new p, because
//! 2 a = 2 − 2 (g + g²) a: two products instead of four. In fixed point the output
//! settles within 2^-28/(g² a) of a constant input: 6.5e-7 at 2 kHz, 6.1e-5 at
//! 20 kHz, half a sensor's step.

use serde::{Deserialize, Serialize};

use core::f64::consts::PI;

use crate::{Error, Parameter, Real};

/// Corner frequency of H50, Hz.
pub const CORNER_HZ: f64 = 50.0;

/// Coefficients of one third-order Butterworth low-pass filter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Config<R: Real> {
    /// g/(1 + g) of the first-order section.
    pub first: R::Coefficient,
    /// 2 (g + g²) and g² over 1 + g + g²: decay of the second-order section's
    /// inner state, and weight of its input.
    pub second: [R::Coefficient; 2],
}

/// The filter's state; the default is rest.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct State<R> {
    pub(crate) first: R,
    /// p and s₂.
    pub(crate) second: [R; 2],
}

impl<R: Real> Config<R> {
    /// A filter with its corner (−3.01 dB) at `corner_hz`, for `tick_hz` samples per second.
    ///
    /// # Errors
    /// [`Parameter::Corner`] unless 0 < `corner_hz` < `tick_hz`/2.
    pub fn new(corner_hz: f64, tick_hz: f64) -> Result<Self, Error> {
        let ratio = corner_hz / tick_hz;
        if !(ratio > 0.0 && ratio < 0.5) {
            let parameter = Parameter::Corner;
            return Err(Error { parameter });
        }
        let g = libm::tan(PI * ratio);
        let a1 = 1.0 / (1.0 + g + g * g);
        Ok(Self {
            first: R::coefficient(g / (1.0 + g)),
            second: [2.0 * (g + g * g) * a1, g * g * a1].map(R::coefficient),
        })
    }

    /// Filters one sample. The gain at zero frequency is 1; for inputs within ±1.6
    /// the output stays within ±2: a third-order Butterworth filter overshoots by at most
    /// 1.2 for the worst bounded input. Beyond that the filter begins again at rest.
    #[inline]
    pub fn process(&self, state: &mut State<R>, x: R) -> R {
        let half = (x - state.first).times(self.first);
        let y = state.first + half;
        state.first = y + half;

        // In increments: at high tick rates the coefficients are small, and so
        // are their rounding errors.
        let [leak, into] = self.second;
        let [p, s2] = state.second;
        let next = p - p.times(leak) + (y - s2).times(into);
        let rise = p + next;
        let v2 = s2 + rise;
        state.second = [next, v2 + rise];
        if !v2.is_within(R::TWO) {
            // Its bits were flipped, or its input was no number.
            *state = State::default();
            return R::ZERO;
        }
        v2
    }
}

#[cfg(test)]
mod tests {
    use super::{CORNER_HZ, Config, State};
    use core::f64::consts::PI;

    /// Gain at `hz`, by correlation with a sine over whole periods.
    fn gain(hz: f64, tick_hz: f64) -> f64 {
        let config = Config::<f64>::new(CORNER_HZ, tick_hz).unwrap();
        let mut state = State::default();
        let (settle, count) = (tick_hz as usize, tick_hz as usize);
        let (mut re, mut im) = (0.0, 0.0);
        for n in 0..settle + count {
            let phase = 2.0 * PI * hz * n as f64 / tick_hz;
            let y = config.process(&mut state, phase.sin());
            if n >= settle {
                re += y * phase.sin();
                im += y * phase.cos();
            }
        }
        2.0 * re.hypot(im) / count as f64
    }

    #[test]
    fn magnitude_is_butterworth_of_third_order_through_the_bilinear_map() {
        for tick_hz in [200.0, 2_000.0, 4_000.0, 20_000.0] {
            for hz in [5.0, 25.0, 50.0, 80.0] {
                let warped = (PI * hz / tick_hz).tan() / (PI * CORNER_HZ / tick_hz).tan();
                let expected = 1.0 / (1.0 + warped.powi(6)).sqrt();
                let error = (gain(hz, tick_hz) - expected).abs();
                assert!(error < 1e-9, "{tick_hz} {hz}: {error:e}");
            }
        }
    }

    #[test]
    fn a_corner_at_or_above_half_the_rate_is_refused() {
        assert!(Config::<f32>::new(50.0, 100.0).is_err());
        assert!(Config::<f32>::new(50.0, f64::NAN).is_err());
        assert!(Config::<f32>::new(0.0, 2_000.0).is_err());
        assert!(Config::<f32>::new(50.0, 101.0).is_ok());
    }
}
