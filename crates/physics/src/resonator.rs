//! A damped resonator, stepped exactly.

use core::f64::consts::TAU;

/// d²x/dt² + 2 ζ ω dx/dt + ω² (x − target) = 0 with 0 < ζ < 1: one bending mode
/// of a whisker, for a target that is constant during the step.
#[derive(Debug, Clone, Copy, Default)]
pub struct Resonator {
    /// Deflection.
    pub x: f64,
    /// Its rate, 1/s.
    pub v: f64,
}

/// The 2×2 exponential of a step, rows (x, v).
#[derive(Debug, Clone, Copy, Default)]
pub struct Propagator {
    x: [f64; 2],
    v: [f64; 2],
}

impl Propagator {
    /// For a mode of `hz` (undamped) with damping ratio `damping`, over `dt_s`.
    ///
    /// With σ = ζ ω, ω_d = ω √(1 − ζ²), c and s the cosine and sine of ω_d dt:
    /// e^(−σ dt) [[c + σ s/ω_d, s/ω_d], [−ω² s/ω_d, c − σ s/ω_d]].
    pub fn new(hz: f64, damping: f64, dt_s: f64) -> Self {
        let omega = TAU * hz;
        let sigma = damping * omega;
        let ringing = omega * (1.0 - damping * damping).sqrt();
        let decay = libm::exp(-sigma * dt_s);
        let (sine, cosine) = libm::sincos(ringing * dt_s);
        let (cosine, share) = (decay * cosine, decay * sine / ringing);
        Self {
            x: [cosine + sigma * share, share],
            v: [-omega * omega * share, cosine - sigma * share],
        }
    }

    /// Deflection and rate after the step, towards `target`.
    #[inline]
    pub(crate) fn apply(&self, x: f64, v: f64, target: f64) -> [f64; 2] {
        let away = x - target;
        [
            target + self.x[0] * away + self.x[1] * v,
            self.v[0] * away + self.v[1] * v,
        ]
    }
}

impl Resonator {
    /// One step towards `target`.
    #[inline]
    pub fn step(&mut self, over: &Propagator, target: f64) {
        [self.x, self.v] = over.apply(self.x, self.v, target);
    }
}

#[cfg(test)]
mod tests {
    use super::{Propagator, Resonator};
    use core::f64::consts::TAU;

    #[test]
    fn ring_down_is_the_closed_form_at_any_step() {
        let (hz, damping) = (50.0, 0.1_f64);
        let ringing = TAU * hz * (1.0 - damping * damping).sqrt();
        for steps in [1, 7, 1000] {
            let time = 0.013;
            let over = Propagator::new(hz, damping, time / f64::from(steps));
            // Released from 1 above a target of 3, with v such that x is a pure cosine.
            let mut mode = Resonator {
                x: 4.0,
                v: -damping * TAU * hz,
            };
            for _ in 0..steps {
                mode.step(&over, 3.0);
            }
            let expected = (-damping * TAU * hz * time).exp() * (ringing * time).cos();
            assert!((mode.x - 3.0 - expected).abs() < 1e-12, "{steps}");
        }
    }
}
