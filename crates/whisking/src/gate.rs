//! Modulation by contact: RCP suppresses a side, CIA excites every whisker
//! (BIOTACT eqs. 9 to 14, as mended).

use crate::{Integrator, Real};

/// Rapid cessation of protraction (eq. 10): z = ⟨max(keep · z, σ_z π)⟩ on \[0, 1\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rcp<R> {
    /// What a tick leaves of z: exp(−T/τ_z), or 1 − T/τ_z in the papers' integrator.
    pub keep: R,
    /// σ_z.
    pub gain: R,
}

/// Contact-induced asymmetry (eqs. 12 and 13): g returns to its nominal value
/// and is lifted to g_nominal + σ_g ζ, on \[0, 2\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cia<R> {
    /// How much of the way to nominal a tick goes: 1 − exp(−T/τ_g), or T/τ_g.
    pub approach: R,
    /// σ_g.
    pub gain: R,
}

/// The part of an exponential decay that one tick takes, 1 − exp(−T/τ) or its
/// first-order value T/τ.
pub(crate) fn approach(ticks: f64, integrator: Integrator) -> f64 {
    match integrator {
        Integrator::Euler => 1.0 / ticks,
        Integrator::Exact => -libm::expm1(-1.0 / ticks),
    }
}

impl<R: Real> Rcp<R> {
    /// z after a tick with contact `pi`. Always within \[0, 1\]: a NaN counts as no suppression.
    #[inline]
    pub fn step(&self, z: R, pi: R) -> R {
        (self.keep * z).max(self.gain * pi).clamp(R::ZERO, R::ONE)
    }
}

impl<R: Real> Cia<R> {
    /// g of a whisker of gain `nominal` after a tick in which the array's
    /// strongest contact was `zeta` (eq. 14). Always within \[0, 2\].
    #[inline]
    pub fn step(&self, g: R, nominal: R, zeta: R) -> R {
        let returned = g + self.approach * (nominal - g);
        returned
            .max(nominal + self.gain * zeta)
            .clamp(R::ZERO, R::ONE + R::ONE)
    }
}

#[cfg(test)]
mod tests {
    use super::{Cia, Rcp, approach};
    use crate::Integrator;

    #[test]
    fn suppression_rises_at_once_and_decays_with_its_time_constant() {
        let rcp = Rcp {
            keep: 1.0 - approach(250.0, Integrator::Exact),
            gain: 0.7,
        };
        let mut z = rcp.step(0.0_f64, 0.5);
        assert!((z - 0.35).abs() < 1e-15);
        for _ in 0..250 {
            z = rcp.step(z, 0.0);
        }
        assert!((z - 0.35 * (-1.0_f64).exp()).abs() < 1e-12);
        assert_eq!(rcp.step(0.2, 9.0), 1.0);
        assert_eq!(rcp.step(f64::NAN, f64::NAN), 0.0);
    }

    #[test]
    fn excitation_lifts_above_nominal_and_returns_from_either_side() {
        let cia = Cia {
            approach: approach(250.0, Integrator::Exact),
            gain: 0.5,
        };
        let lifted = cia.step(1.0_f64, 1.0, 0.8);
        assert!((lifted - 1.4).abs() < 1e-15);
        let (mut above, mut below) = (lifted, 0.3);
        for _ in 0..250 {
            above = cia.step(above, 1.0, 0.0);
            below = cia.step(below, 1.0, 0.0);
        }
        assert!((above - (1.0 + 0.4 * (-1.0_f64).exp())).abs() < 1e-12);
        assert_eq!(
            below, 1.0,
            "without contact g is not below nominal (eq. 12)"
        );
        assert_eq!(cia.step(1.0, 1.0, 100.0), 2.0);
    }

    #[test]
    fn the_papers_decay_is_first_order() {
        assert_eq!(approach(0.5, Integrator::Euler), 2.0);
        assert!(approach(0.5, Integrator::Exact) < 1.0);
    }
}
