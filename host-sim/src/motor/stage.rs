//! From pins to torque: what the windings do in the two power stages.
//!
//! Both give a torque that is linear in the speed, drive − damping ω. With
//! terminal voltages v_k and torque factors c_k (torque per ampere into
//! terminal k), back-EMF c_k ω and a resistance r in each terminal, star
//! connected, over the terminals that carry current:
//!
//! drive = Σ (c_k − c̄) v_k / r, damping = Σ (c_k − c̄)² / r.
//!
//! A brushed winding is the case of two terminals with c = ±k/2 and r = R/2.
//! A brushless one has c_k = (k/√3) sin(axis_k − α) for rotor angle α, so that
//! two phases in series have the factor k where the field leads by 90°.

use core::f64::consts::TAU;

use super::MotorSettings;
use super::pins::Wires;
use super::rotor::Rotor;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stage {
    /// PWM 0 across the winding, pin 0 its direction.
    Brushed,
    /// PWM k on phase k, pin k its enable.
    Brushless,
}

/// Torque of the winding: drive − damping ω.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Winding {
    /// At standstill, N·m.
    pub(super) drive_nm: f64,
    /// By back-EMF, N·m·s.
    pub(super) damping_nm_s: f64,
}

/// A terminal that carries current: voltage and torque factor.
#[derive(Debug, Clone, Copy)]
struct Terminal {
    volts: f64,
    factor: f64,
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

    /// Terminals with current, in order; `None` for one without.
    fn terminals(self, s: &MotorSettings, wires: &Wires, angle: f64) -> [Option<Terminal>; 3] {
        let factor = |i| match (self, i) {
            (Self::Brushed, 0) => s.torque_nm_per_a / 2.0,
            (Self::Brushed, 1) => -s.torque_nm_per_a / 2.0,
            (Self::Brushed, _) => 0.0,
            (Self::Brushless, i) => {
                let axis = TAU / 3.0 * i as f64;
                s.torque_nm_per_a / 3.0_f64.sqrt() * libm::sin(axis - angle)
            }
        };
        let volts = |i| match self {
            Self::Brushed => {
                if (i == 0) == wires.is_forward() {
                    s.supply_v * wires.duty(0)
                } else {
                    0.0
                }
            }
            Self::Brushless => s.supply_v * wires.duty(i),
        };
        let live = |i| match self {
            Self::Brushed => i < 2 && !wires.is_cut(0) && !wires.is_cut(1),
            Self::Brushless => wires.is_high(i) && !wires.is_cut(i),
        };
        [0, 1, 2].map(|i| {
            live(i).then(|| Terminal {
                volts: volts(i),
                factor: factor(i),
            })
        })
    }

    pub(super) fn winding(self, s: &MotorSettings, wires: &Wires, angle: f64) -> Winding {
        match self {
            Self::Brushed => Self::brushed_winding(s, wires),
            Self::Brushless => self.star_winding(s, wires, angle),
        }
    }

    /// The sums above for two terminals, which are alike but for their signs: they need no star
    /// point.
    fn brushed_winding(s: &MotorSettings, wires: &Wires) -> Winding {
        if wires.is_cut(0) || wires.is_cut(1) {
            return Winding::default();
        }
        let (factor, ohm) = (s.torque_nm_per_a / 2.0, s.resistance_ohm / 2.0);
        let drive_nm = factor * (s.supply_v * wires.duty(0)) / ohm;
        Winding {
            drive_nm: if wires.is_forward() {
                drive_nm
            } else {
                -drive_nm
            },
            damping_nm_s: 2.0 * (factor * factor / ohm),
        }
    }

    fn star_winding(self, s: &MotorSettings, wires: &Wires, angle: f64) -> Winding {
        let terminals = self.terminals(s, wires, angle);
        let mean = star_point(&terminals);
        let mut winding = Winding::default();
        for terminal in terminals.iter().flatten() {
            let factor = terminal.factor - mean.factor;
            winding.drive_nm += factor * terminal.volts / (s.resistance_ohm / 2.0);
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

    /// Current into each terminal, A.
    pub(super) fn currents(self, s: &MotorSettings, wires: &Wires, rotor: &Rotor) -> [f64; 3] {
        let terminals = self.terminals(s, wires, rotor.angle);
        let mean = star_point(&terminals);
        terminals.map(|terminal| {
            terminal.map_or(0.0, |terminal| {
                let emf = (terminal.factor - mean.factor) * rotor.speed;
                (terminal.volts - mean.volts - emf) / (s.resistance_ohm / 2.0)
            })
        })
    }
}

fn star_point(terminals: &[Option<Terminal>; 3]) -> Terminal {
    let count = terminals.iter().flatten().count().max(1) as f64;
    Terminal {
        volts: terminals.iter().flatten().map(|t| t.volts).sum::<f64>() / count,
        factor: terminals.iter().flatten().map(|t| t.factor).sum::<f64>() / count,
    }
}
