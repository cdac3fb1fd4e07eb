//! Modulation by contact: RCP suppresses a side, CIA excites every whisker
//! (BIOTACT eqs. 9 to 14, as mended).

use crate::{Integrator, Real};

/// A gating variable, z of a side or g of a whisker, and what rounding took
/// from its decay.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Gate<R: Real> {
    /// Its value.
    pub value: R,
    carry: R::Carry,
}

/// Rapid cessation of protraction (eq. 10): z = ⟨max(z − decay · z, σ_z π)⟩ on \[0, 1\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rcp<R: Real> {
    /// What a tick takes of z: 1 − exp(−T/τ_z), or T/τ_z in the papers' integrator.
    pub decay: R::Coefficient,
    /// σ_z.
    pub gain: R::Coefficient,
}

/// Contact-induced asymmetry (eqs. 12 and 13): g returns to its nominal value
/// and is lifted to g_nominal + σ_g ζ, on \[0, 2\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cia<R: Real> {
    /// How much of the way to nominal a tick goes: 1 − exp(−T/τ_g), or T/τ_g.
    pub approach: R::Coefficient,
    /// σ_g.
    pub gain: R::Coefficient,
}

/// The part of an exponential decay that one tick takes, 1 − exp(−T/τ) or its
/// first-order value T/τ.
pub(crate) fn approach(ticks: f64, integrator: Integrator) -> f64 {
    match integrator {
        Integrator::Euler => 1.0 / ticks,
        Integrator::Exact => -libm::expm1(-1.0 / ticks),
    }
}

impl<R: Real> Gate<R> {
    /// A gate at `value`.
    pub fn new(value: R) -> Self {
        Self {
            value,
            carry: R::Carry::default(),
        }
    }

    /// Relaxes to `rest`, but not below `floor`; always within 0..=`top`, NaN
    /// included.
    #[inline]
    fn step(&mut self, rest: R, share: R::Coefficient, floor: R, top: R) {
        self.value.relax(&mut self.carry, rest, share);
        self.value = self.value.max(floor).clamp(R::ZERO, top);
    }
}

impl<R: Real> Rcp<R> {
    /// A tick of z with contact `pi`. Always within \[0, 1\].
    #[inline]
    pub fn step(&self, z: &mut Gate<R>, pi: R) {
        z.step(R::ZERO, self.decay, pi.times(self.gain), R::ONE);
    }
}

impl<R: Real> Cia<R> {
    /// A tick of g of a whisker of gain `nominal`, with the array's strongest
    /// contact `zeta` (eq. 14). Always within \[0, 2\].
    #[inline]
    pub fn step(&self, g: &mut Gate<R>, nominal: R, zeta: R) {
        g.step(
            nominal,
            self.approach,
            nominal + zeta.times(self.gain),
            R::TWO,
        );
    }
}

#[cfg(test)]
mod tests {
    use super::{Cia, Gate, Rcp, approach};
    use crate::{Fix, Integrator, Real};

    fn rcp<R: Real>(ticks: f64) -> Rcp<R> {
        let decay = R::coefficient(approach(ticks, Integrator::Exact));
        Rcp {
            decay,
            gain: R::coefficient(0.7),
        }
    }

    #[test]
    fn suppression_rises_at_once_and_decays_with_its_time_constant() {
        let rcp = rcp::<f64>(250.0);
        let mut z = Gate::new(0.0);
        rcp.step(&mut z, 0.5);
        assert!((z.value - 0.35).abs() < 1e-15);
        for _ in 0..250 {
            rcp.step(&mut z, 0.0);
        }
        assert!((z.value - 0.35 * (-1.0_f64).exp()).abs() < 1e-12);
        rcp.step(&mut z, 9.0);
        assert_eq!(z.value, 1.0);
    }

    /// No contact that is not a number leaves a gate that is not a number.
    #[test]
    fn a_gate_recovers_from_anything() {
        let rcp = rcp::<f32>(250.0);
        let mut z = Gate::new(0.5_f32);
        for pi in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::NAN, 0.0] {
            rcp.step(&mut z, pi);
            assert!((0.0..=1.0).contains(&z.value));
        }
        rcp.step(&mut z, 0.5);
        for _ in 0..2_500 {
            rcp.step(&mut z, 0.0);
        }
        assert!(z.value < 1e-4, "{z:?}");
    }

    #[test]
    fn excitation_lifts_above_nominal_and_returns() {
        let decay = approach(250.0, Integrator::Exact);
        let cia = Cia {
            approach: decay,
            gain: 0.5,
        };
        let mut g = Gate::new(1.0_f64);
        cia.step(&mut g, 1.0, 0.8);
        assert!((g.value - 1.4).abs() < 1e-15);
        for _ in 0..250 {
            cia.step(&mut g, 1.0, 0.0);
        }
        assert!((g.value - (1.0 + 0.4 * (-1.0_f64).exp())).abs() < 1e-12);
        let mut low = Gate::new(0.3);
        cia.step(&mut low, 1.0, 0.0);
        assert_eq!(
            low.value, 1.0,
            "without contact g is not below nominal (eq. 12)"
        );
        cia.step(&mut g, 1.0, 100.0);
        assert_eq!(g.value, 2.0);
    }

    #[test]
    fn the_slowest_decay_arrives_in_every_format() {
        fn after<R: Real>() -> f64 {
            let rcp = rcp::<R>(4e8);
            let mut z = Gate::new(R::ONE);
            for _ in 0..4_000_000 {
                rcp.step(&mut z, R::ZERO);
            }
            z.value.to_f64()
        }
        let expected = (-0.01_f64).exp();
        for (found, within) in [
            (after::<f64>(), 1e-9),
            (after::<f32>(), 2e-7),
            (after::<Fix>(), 1e-8),
        ] {
            assert!((found - expected).abs() < within, "{found} {expected}");
        }
    }

    #[test]
    fn the_papers_decay_is_first_order() {
        assert_eq!(approach(0.5, Integrator::Euler), 2.0);
        assert!(approach(0.5, Integrator::Exact) < 1.0);
    }
}
