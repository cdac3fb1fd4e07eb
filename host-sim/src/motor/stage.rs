//! From pins to torque: what the windings do in the two power stages.
//!
//! Both give a torque that is linear in the speed, drive − damping ω. With terminal voltages v_k
//! and torque factors c_k (torque per ampere into terminal k), back-EMF c_k ω and a resistance r in
//! each terminal, star connected, over the terminals that carry current:
//!
//! drive = Σ (c_k − c̄) v_k / r, damping = Σ (c_k − c̄)² / r.
//!
//! A brushed winding is the case of two terminals with c = ±k/2 and r = R/2.
//! A brushless one has c_k = (k/√3) sin(axis_k − α) for rotor angle α, so that
//! two phases in series have the factor k where the field leads by 90°.

use core::f64::consts::TAU;

use super::MotorSettings;
use super::pins::{Wire, Wires};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stage {
    /// PWM 0 across the winding, pin 0 its direction.
    Brushed,
    /// PWM k on phase k, pin k its enable.
    Brushless,
}

#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Winding {
    /// At standstill, N·m.
    pub(super) drive_nm: f64,
    /// By back-EMF, N·m·s.
    pub(super) damping_nm_s: f64,
}

/// Substeps never turn the rotor, or swing it about a standing field, further
/// than this, rad: the torque changes by 2 % at most.
const TURN: f64 = 0.02;
/// Bound on the work of one call; beyond it accuracy suffers, not stability.
const MOST_SUBSTEPS: f64 = 10_000.0;

impl Stage {
    /// Into how many parts a step must be cut for the torque to follow the angle.
    pub(super) fn substeps(self, s: &MotorSettings, speed: f64, dt_s: f64) -> u32 {
        if self == Self::Brushed {
            return 1;
        }
        let acceleration = s.torque_nm_per_a * s.supply_v / (s.resistance_ohm * s.inertia_kg_m2());
        // Swings in a standing field have ω² = acceleration.
        let rate = (speed.abs() + acceleration * dt_s).max(acceleration.sqrt());
        // A cast to an integer saturates and makes 0 of NaN.
        (rate * dt_s / TURN).ceil().clamp(1.0, MOST_SUBSTEPS) as u32
    }

    pub(super) fn winding(self, s: &MotorSettings, wires: &Wires, angle: f64) -> Winding {
        match self {
            Self::Brushed => Self::brushed_winding(s, wires),
            Self::Brushless => Self::star_winding(s, wires, angle),
        }
    }

    /// The sums above for two terminals, which are alike but for their signs: they need no star
    /// point.
    fn brushed_winding(s: &MotorSettings, wires: &Wires) -> Winding {
        if [0, 1].iter().any(|i| wires.is_cut(Wire::Winding(*i))) {
            return Winding::default();
        }
        let (factor, ohm) = (s.torque_nm_per_a / 2.0, s.resistance_ohm / 2.0);
        let drive_nm = factor * (s.supply_v * wires.duty(0)) / ohm;
        // Whether the driver pulls terminal 0 up.
        let is_forward = wires.is_high(0) != wires.is_cut(Wire::Windings);
        Winding {
            drive_nm: if is_forward { drive_nm } else { -drive_nm },
            damping_nm_s: 2.0 * (factor * factor / ohm),
        }
    }

    fn star_winding(s: &MotorSettings, wires: &Wires, angle: f64) -> Winding {
        let terminals = [0, 1, 2].map(|i| {
            let axis = TAU / 3.0 * i as f64;
            let factor = s.torque_nm_per_a / 3.0_f64.sqrt() * libm::sin(axis - angle);
            let is_live = wires.is_high(i) && !wires.is_cut(Wire::Winding(i));
            is_live.then(|| (s.supply_v * wires.duty(i), factor))
        });
        let live = || terminals.iter().flatten();
        let count = live().count().max(1) as f64;
        let mean = live().map(|(_, factor)| factor).sum::<f64>() / count;
        let mut winding = Winding::default();
        for (volts, factor) in live() {
            let factor = factor - mean;
            winding.drive_nm += factor * volts / (s.resistance_ohm / 2.0);
            winding.damping_nm_s += factor * factor / (s.resistance_ohm / 2.0);
        }
        winding
    }

    /// What its pins ask for: the largest duty of a half-bridge that is enabled, 0 to 1.
    pub(super) fn effort(self, wires: &Wires) -> f64 {
        match self {
            Self::Brushed => wires.duty(0),
            Self::Brushless => {
                let enabled = (0..3).filter(|&i| wires.is_high(i));
                enabled.map(|i| wires.duty(i)).fold(0.0, f64::max)
            }
        }
    }

    /// The same with the sign of the torque that they ask for at a rotor angle.
    pub(super) fn duty(self, s: &MotorSettings, wires: &Wires, angle: f64) -> f64 {
        let effort = self.effort(wires);
        match self {
            Self::Brushed if wires.is_high(0) => effort,
            Self::Brushed => -effort,
            Self::Brushless => effort.copysign(self.winding(s, wires, angle).drive_nm),
        }
    }
}
