//! Modal amplitudes of a whisker, and how they move in a step.

use core::f64::consts::TAU;

use crate::beam::{BendingMode, Modes};
use crate::compliance::Compliance;
use crate::pose::PlatePose;
use crate::resonator::{Propagator, Resonator};
use crate::shaft::Shaft;
use crate::vector::{V3, add, length2};

/// Modes that are kept. For a shaft of taper 8 the fourth rings at ten times the
/// first's frequency, beyond what a sensor of 2 to 4 kHz resolves; the static
/// response of the rest is kept as a residual.
pub(crate) const MODES: usize = 4;

/// The constants of a shaft that a step needs.
#[derive(Debug, Clone)]
pub(crate) struct ModalShaft {
    pub(crate) length_m: f64,
    pub(crate) tip_radius_m: f64,
    omega: [f64; MODES],
    damping: f64,
    tip: [f64; MODES],
    base: [f64; MODES],
    /// Change of rate of each mode, with a minus, for a change of the base's
    /// velocity by 1 m/s and of its angular velocity by 1 rad/s.
    drive: [[f64; 2]; MODES],
    /// κ, 1/m.
    shortening: f64,
    residual_tip: f64,
    residual_base: f64,
    /// Compliance along the shaft, m/N.
    axial: f64,
    /// Σ φ_k(L)², 1/kg: velocity of the tip for an impulse on it.
    pub(crate) mobility: f64,
    pub(crate) highest_rad_s: f64,
}

impl ModalShaft {
    /// The constants of a checked shaft with its modes.
    pub(crate) fn new(shaft: &Shaft, modes: &Modes) -> Self {
        let of = |k: usize| modes.modes.get(k).copied();
        let part = |k: usize, value: fn(BendingMode) -> f64| of(k).map_or(0.0, value);
        // A mode that is missing has no shape; any frequency does for it.
        let omega = core::array::from_fn(|k| of(k).map_or(1.0, |m| m.omega_rad_s));
        let tip: [f64; MODES] = core::array::from_fn(|k| part(k, |m| m.tip));
        // Static response of modes that were solved and are not kept.
        let rest = |of: fn(&BendingMode) -> f64| -> f64 {
            let more = modes.modes.iter().skip(MODES);
            more.map(|m| m.tip * of(m) / (m.omega_rad_s * m.omega_rad_s))
                .sum()
        };
        Self {
            length_m: shaft.length_m,
            tip_radius_m: shaft.tip_diameter_m / 2.0,
            omega,
            damping: shaft.damping,
            tip,
            base: core::array::from_fn(|k| part(k, |m| m.base_rotation)),
            drive: core::array::from_fn(|k| [part(k, |m| m.translation), part(k, |m| m.rotation)]),
            shortening: modes.shortening_m,
            residual_tip: modes.residual_tip_m_n + rest(|m| m.tip),
            residual_base: modes.residual_base_rad_n + rest(|m| m.base_rotation),
            axial: 1.0 / shaft.follicle.axial_n_m,
            mobility: tip.iter().map(|t| t * t).sum::<f64>(),
            highest_rad_s: omega.iter().copied().fold(0.0, f64::max),
        }
    }

    /// Deflections of the modal tip in x and y, m.
    #[inline]
    pub(crate) fn deflections(&self, state: &ModalState) -> [f64; 2] {
        weighted(&self.tip, &state.x)
    }

    /// The modal tip with these deflections in the plate's coordinates, m.
    #[inline]
    pub(crate) fn tip(&self, deflections: [f64; 2], pose: &PlatePose) -> V3 {
        pose.tip(deflections, self.shortened_m(deflections))
    }

    /// How far a deflected tip has come back along the shaft, m: κ |u|²/2, and
    /// from |u| = 1/κ on, where the theory ends, in proportion.
    #[inline]
    pub(crate) fn shortened_m(&self, deflections: [f64; 2]) -> f64 {
        let relative = length2(deflections) * self.shortening;
        if relative > 1.0 {
            let straight = relative - 1.0;
            let bent = relative - straight;
            (0.5 * bent * bent + straight) / self.shortening
        } else {
            0.5 * relative * relative / self.shortening
        }
    }

    /// Motion of the tip for a deflection of 1 more in x and in y.
    #[inline]
    pub(crate) fn ways(&self, [u, v]: [f64; 2], pose: &PlatePose) -> [V3; 2] {
        let relative = self.shortening * length2([u, v]);
        let steep = if relative > 1.0 {
            self.shortening / relative
        } else {
            self.shortening
        };
        [
            add(pose.x, -steep * u, pose.z),
            add(pose.y, -steep * v, pose.z),
        ]
    }

    /// Change of the tip's direction of motion for a change of deflection, rad.
    #[inline]
    pub(crate) fn turn(&self, change_m: f64) -> f64 {
        self.shortening * change_m
    }

    /// The massless compliance of the shaft in series with that of a surface, m/N.
    #[inline]
    pub(crate) fn compliance(&self, surface_m_n: f64) -> Compliance {
        Compliance {
            across: surface_m_n + self.residual_tip,
            along: surface_m_n + self.axial,
        }
    }

    /// Deflections under a force on the tip, with the residual part, m.
    pub(crate) fn deflection(&self, state: &ModalState, force: [f64; 2]) -> [f64; 2] {
        let [u, v] = self.deflections(state);
        [
            u + self.residual_tip * force[0],
            v + self.residual_tip * force[1],
        ]
    }

    /// Rotation of the base, rad.
    #[inline]
    pub(crate) fn rotation(&self, state: &ModalState, force: [f64; 2]) -> [f64; 2] {
        let [x, y] = weighted(&self.base, &state.x);
        [
            x + self.residual_base * force[0],
            y + self.residual_base * force[1],
        ]
    }

    /// At rest under the static force that brings the modal tip to u.
    pub(crate) fn bent(&self, tip_m: [f64; 2]) -> ModalState {
        let compliance = |k: usize| self.tip[k] / (self.omega[k] * self.omega[k]);
        let whole: f64 = (0..MODES).map(|k| self.tip[k] * compliance(k)).sum();
        ModalState {
            x: core::array::from_fn(|k| tip_m.map(|u| u / whole * compliance(k))),
            v: [[0.0; 2]; MODES],
        }
    }
}

/// Σ wₖ qₖ in both axes.
#[inline]
fn weighted(weights: &[f64; MODES], values: &[[f64; 2]; MODES]) -> [f64; 2] {
    [0, 1].map(|axis| {
        let terms = weights.iter().zip(values).map(|(w, value)| w * value[axis]);
        terms.sum()
    })
}

/// How modes move in one part of a step.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ModalStep {
    over: [Propagator; MODES],
    /// Amplitude and rate at the end for a force of 1 N on the tip.
    push: [[f64; 2]; MODES],
    /// Displacement of the modal tip for it, m/N.
    pub(crate) response: f64,
}

impl ModalStep {
    pub(crate) fn new(shaft: &ModalShaft, dt_s: f64) -> Self {
        let over = shaft
            .omega
            .map(|omega| Propagator::new(omega / TAU, shaft.damping, dt_s));
        let push: [[f64; 2]; MODES] = core::array::from_fn(|k| {
            let mut mode = Resonator::default();
            mode.step(&over[k], shaft.tip[k] / (shaft.omega[k] * shaft.omega[k]));
            [mode.x, mode.v]
        });
        let response = push.iter().zip(&shaft.tip).map(|(push, tip)| push[0] * tip);
        Self {
            over,
            push,
            response: response.sum(),
        }
    }
}

/// Amplitudes and rates of the modes. The two axes stand side by side, so that
/// they are computed together.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ModalState {
    /// q of each mode in x and y, m √kg.
    x: [[f64; 2]; MODES],
    /// Its rate, m √kg/s.
    v: [[f64; 2]; MODES],
}

impl ModalState {
    /// Moves on without a force.
    #[inline]
    pub(crate) fn free(&mut self, step: &ModalStep) {
        for ((x, v), over) in self.x.iter_mut().zip(&mut self.v).zip(&step.over) {
            for (x, v) in x.iter_mut().zip(v) {
                [*x, *v] = over.apply(*x, *v, 0.0);
            }
        }
    }

    /// Adds the effect of a force that acted during the part.
    #[inline]
    pub(crate) fn push(&mut self, step: &ModalStep, force: [f64; 2]) {
        for ((x, v), push) in self.x.iter_mut().zip(&mut self.v).zip(&step.push) {
            for axis in 0..2 {
                x[axis] += push[0] * force[axis];
                v[axis] += push[1] * force[axis];
            }
        }
    }

    /// Adds the amplitudes of another state.
    pub(crate) fn add_amplitudes(&mut self, more: &Self) {
        for (x, more) in self.x.iter_mut().flatten().zip(more.x.iter().flatten()) {
            *x += more;
        }
    }

    /// Changes the base's velocity and angular velocity along each axis.
    #[inline]
    pub(crate) fn kick(&mut self, shaft: &ModalShaft, shift: [f64; 2], turn: [f64; 2]) {
        for (v, drive) in self.v.iter_mut().zip(&shaft.drive) {
            for axis in 0..2 {
                v[axis] -= drive[0] * shift[axis] + drive[1] * turn[axis];
            }
        }
    }

    /// Speed of the tip across the shaft, m/s.
    #[inline]
    pub(crate) fn speed(&self, shaft: &ModalShaft) -> f64 {
        length2(weighted(&shaft.tip, &self.v))
    }

    /// Kinetic and elastic energy, J.
    pub(crate) fn energy_j(&self, shaft: &ModalShaft) -> f64 {
        let of = |axis: usize| -> f64 {
            let modes = self.x.iter().zip(&self.v).zip(&shaft.omega);
            modes
                .map(|((x, v), omega)| 0.5 * (v[axis] * v[axis] + (omega * x[axis]).powi(2)))
                .sum()
        };
        of(0) + of(1)
    }

    /// Cuts a deflection of the tip of more than twice the length back to that:
    /// linear theory has ended long before, and a shaft would have broken. Says
    /// whether it did.
    #[inline]
    pub(crate) fn limit(&mut self, shaft: &ModalShaft) -> bool {
        let [u, v] = shaft.deflections(self);
        let most = 2.0 * shaft.length_m;
        let square = u * u + v * v;
        let beyond = square > most * most;
        if beyond {
            let cut = most / square.sqrt();
            for value in self.x.iter_mut().chain(&mut self.v).flatten() {
                *value *= cut;
            }
        }
        beyond
    }

    #[inline]
    pub(crate) fn is_finite(&self) -> bool {
        let mut values = self.x.iter().chain(&self.v).flatten();
        values.all(|value| value.is_finite())
    }
}
