//! Modulation by contact: RCP suppresses a side, CIA excites every whisker
//! (BIOTACT eqs. 9 to 14, as mended).

use serde::{Deserialize, Serialize};

use crate::{Integrator, Real};

/// How far contact has raised z of a side above 0, or g of a whisker above its nominal value.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Gate<R: Real> {
    /// The value that the next tick begins with, not negative.
    pub value: R,
    /// The mean over the tick, in which the value decays or is held by contact.
    pub mean: R,
    /// Rounding error of a slow decay.
    pub(crate) carry: R::Carry,
}

/// One tick of an exponential decay.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Decay<R: Real> {
    /// The fraction that a tick removes: 1 − exp(−T/τ), or T/τ, at most 1, in the
    /// papers' integrator.
    pub tick: R::Fine,
    /// The same for half a tick, for the mean; 0 in the papers' integrator.
    pub half: R::Coefficient,
    /// Whether the decay is so slow that its rounding errors must be carried.
    pub slow: bool,
}

/// A decay that removes less than this per tick loses a noticeable part of it
/// to rounding in single precision.
const SLOW: f64 = 1.0 / 256.0;

/// Rapid cessation of protraction (eq. 10): z = ⟨max(z − decay · z, σ_z π)⟩ on \[0, 1\].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Rcp<R: Real> {
    /// Decay of z with τ_z.
    pub decay: Decay<R>,
    /// σ_z.
    pub gain: R::Coefficient,
}

/// Contact-induced asymmetry (eqs. 12 and 13): g returns to its nominal value
/// and is lifted to g_nominal + σ_g ζ, on \[0, 2\].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Cia<R: Real> {
    /// Return of g with τ_g.
    pub decay: Decay<R>,
    /// σ_g.
    pub gain: R::Coefficient,
}

/// The fraction that a tick removes, 1 − exp(−T/τ) or its first-order value T/τ; `ticks` is τ/T.
fn share(ticks: f64, integrator: Integrator) -> f64 {
    match integrator {
        Integrator::Euler => 1.0 / ticks,
        Integrator::Exact => -libm::expm1(-1.0 / ticks),
    }
}

impl<R: Real> Decay<R> {
    /// For `ticks` = τ/T.
    pub(crate) fn new(ticks: f64, integrator: Integrator) -> Self {
        // A share above 1 would make the gate negative; contact, which is not
        // negative, would then set it at once, as it does after a share of 1.
        let tick = share(ticks, integrator).min(1.0);
        let half = match integrator {
            Integrator::Euler => 0.0,
            Integrator::Exact => share(2.0 * ticks, integrator),
        };
        Self {
            tick: R::fine(tick),
            half: R::coefficient(half),
            slow: tick < SLOW,
        }
    }
}

impl<R: Real> Gate<R> {
    /// A gate at `value`.
    pub fn new(value: R) -> Self {
        Self {
            value,
            mean: value,
            carry: R::Carry::default(),
        }
    }

    /// Decays, but not below `floor`; always within 0..=`top`. A floor of NaN is ignored.
    #[inline]
    fn step(&mut self, decay: &Decay<R>, floor: R, top: R) {
        if decay.slow {
            self.value.decay(&mut self.carry, decay.tick);
        } else {
            self.value = self.value - self.value.times_fine(decay.tick);
        }
        // Otherwise, and if it is no number, its bits were flipped.
        let is_sound = self.value <= top;
        if !is_sound {
            *self = Self::default();
        }
        self.mean = self.value - self.value.times(decay.half);
        if floor > self.value {
            let held = if floor < top { floor } else { top };
            (self.value, self.mean) = (held, held);
        }
    }
}

impl<R: Real> Rcp<R> {
    /// A tick of z with contact `pi`. Always within \[0, 1\].
    #[inline]
    pub fn step(&self, z: &mut Gate<R>, pi: R) {
        z.step(&self.decay, pi.times(self.gain), R::ONE);
    }
}

impl<R: Real> Cia<R> {
    /// A tick of the lift of g above `nominal`, with the array's strongest
    /// contact `zeta` (eq. 14). g is always within \[0, 2\].
    #[inline]
    pub fn step(&self, lift: &mut Gate<R>, nominal: R, zeta: R) {
        lift.step(&self.decay, zeta.times(self.gain), R::TWO - nominal);
    }
}

#[cfg(test)]
mod tests {
    use super::{Cia, Decay, Gate, Rcp};
    use crate::{Fix, Integrator, Real};

    fn rcp<R: Real>(integrator: Integrator, ticks: f64) -> Rcp<R> {
        Rcp {
            decay: Decay::new(ticks, integrator),
            gain: R::coefficient(0.7),
        }
    }

    #[test]
    fn suppression_rises_at_once_and_decays_with_its_time_constant() {
        let rcp = rcp::<f64>(Integrator::Exact, 250.0);
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

    /// A contact of NaN or infinity leaves a gate that is a number.
    #[test]
    fn a_gate_recovers_from_anything() {
        let rcp = rcp::<f32>(Integrator::Exact, 250.0);
        let mut z = Gate::new(0.5_f32);
        for pi in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::NAN, 0.0] {
            rcp.step(&mut z, pi);
            assert!((0.0..=1.0).contains(&z.value), "{pi}: {z:?}");
        }
        rcp.step(&mut z, 0.5);
        for _ in 0..2_500 {
            rcp.step(&mut z, 0.0);
        }
        assert!(z.value < 1e-4, "{z:?}");
    }

    #[test]
    fn excitation_lifts_above_nominal_and_returns() {
        let cia = Cia {
            decay: Decay::new(250.0, Integrator::Exact),
            gain: 0.5,
        };
        let mut lift = Gate::new(0.0_f64);
        cia.step(&mut lift, 1.0, 0.8);
        assert!((lift.value - 0.4).abs() < 1e-15);
        for _ in 0..250 {
            cia.step(&mut lift, 1.0, 0.0);
        }
        assert!((lift.value - 0.4 * (-1.0_f64).exp()).abs() < 1e-12);
        cia.step(&mut lift, 1.5, 100.0);
        assert_eq!(lift.value, 0.5, "g is at most 2");
    }

    #[test]
    fn the_slowest_decay_arrives_in_every_format() {
        fn after<R: Real>() -> f64 {
            let rcp = rcp::<R>(Integrator::Exact, 4e8);
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

    /// 1 − T/τ is negative for τ < T, so the demand of contact is the larger.
    #[test]
    fn a_decay_shorter_than_a_tick_leaves_the_demand_of_contact() {
        let rcp = rcp::<f64>(Integrator::Euler, 0.1);
        let mut z = Gate::new(1.0);
        rcp.step(&mut z, 0.5);
        assert_eq!(z.value, 0.35);
        rcp.step(&mut z, 0.0);
        assert_eq!(z.value, 0.0);
        // A contact of NaN demands nothing, and all decays.
        z = Gate::new(1.0);
        rcp.step(&mut z, f64::NAN);
        assert_eq!((z.value, z.mean), (0.0, 0.0));
    }

    #[test]
    fn the_mean_is_half_a_tick_further_unless_contact_holds_the_gate() {
        let (ours, mut z) = (rcp::<f64>(Integrator::Exact, 4.0), Gate::new(0.8));
        ours.step(&mut z, 0.0);
        assert!((z.value - 0.8 * (-0.25_f64).exp()).abs() < 1e-15);
        assert!((z.mean - 0.8 * (-0.375_f64).exp()).abs() < 1e-15);
        ours.step(&mut z, 1.0);
        assert_eq!((z.value, z.mean), (0.7, 0.7));
        let papers = rcp::<f64>(Integrator::Euler, 4.0);
        papers.step(&mut z, 0.0);
        assert!((z.value - 0.525).abs() < 1e-15);
        assert_eq!(z.value, z.mean);
    }
}
