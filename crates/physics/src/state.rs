//! Modal amplitudes of a whisker, and how they move in a step.

use core::f64::consts::TAU;

use super::beam::Modes;
use super::pose::Seen;
use super::shaft::Shaft;
use super::touching::Give;
use super::vector::{V3, add};
use super::{Propagator, Resonator};

/// Modes that are kept. For a shaft of taper 8 the fourth rings at ten times the
/// first's frequency, beyond what a sensor of 2 to 4 kHz resolves; the static
/// response of the rest is kept as a residual.
pub(super) const MODES: usize = 4;

/// What of a shaft a step needs.
#[derive(Debug, Clone)]
pub(super) struct Shape {
    pub(super) length_m: f64,
    pub(super) tip_radius_m: f64,
    omega: [f64; MODES],
    damping: f64,
    tip: [f64; MODES],
    base: [f64; MODES],
    /// Kick of each mode for a velocity of the base, and an angular velocity.
    drive: [[f64; 2]; MODES],
    /// κ, 1/m.
    shortening: f64,
    residual_tip: f64,
    residual_base: f64,
    /// m/N along the shaft.
    axial: f64,
    /// Σ φ_k(L)², 1/kg: velocity of the tip for an impulse on it.
    pub(super) mobility: f64,
    pub(super) highest_rad_s: f64,
}

impl Shape {
    /// Of a checked shaft.
    pub(super) fn new(shaft: &Shaft, modes: &Modes) -> Self {
        let of = |k: usize| modes.modes.get(k).copied();
        let part = |k: usize, value: fn(super::Mode) -> f64| of(k).map_or(0.0, value);
        // A mode that is missing has no shape; any frequency does for it.
        let omega = core::array::from_fn(|k| of(k).map_or(1.0, |m| m.omega_rad_s));
        let tip: [f64; MODES] = core::array::from_fn(|k| part(k, |m| m.tip));
        // Static response of modes that were solved and are not kept.
        let rest = |of: fn(&super::Mode) -> f64| -> f64 {
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

    /// Deflections of the modal tip, m.
    #[inline]
    pub(super) fn deflections(&self, state: &State) -> [f64; 2] {
        let sum = |axis: &[Resonator; MODES]| -> f64 {
            let terms = axis.iter().zip(&self.tip).map(|(mode, tip)| tip * mode.x);
            terms.sum()
        };
        [sum(&state.axes[0]), sum(&state.axes[1])]
    }

    /// The modal tip with these deflections in the plate's coordinates, m.
    #[inline]
    pub(super) fn tip(&self, deflections: [f64; 2], seen: &Seen) -> V3 {
        let [u, v] = deflections;
        let bent = add(add(seen.tip, u, seen.x), v, seen.y);
        add(bent, -self.back(deflections), seen.z)
    }

    /// How far a deflected tip has come back along the shaft, m: κ |u|²/2, and
    /// from |u| = 1/κ on, where the theory ends, in proportion.
    #[inline]
    fn back(&self, [u, v]: [f64; 2]) -> f64 {
        let off = (u * u + v * v).sqrt();
        let straight = (off * self.shortening - 1.0).max(0.0);
        let bent = off * self.shortening - straight;
        (0.5 * bent * bent + straight) / self.shortening
    }

    /// Motion of the tip for a deflection of 1 more in x and in y.
    #[inline]
    pub(super) fn ways(&self, [u, v]: [f64; 2], seen: &Seen) -> [V3; 2] {
        let steep = self.shortening / (self.shortening * (u * u + v * v).sqrt()).max(1.0);
        [
            add(seen.x, -steep * u, seen.z),
            add(seen.y, -steep * v, seen.z),
        ]
    }

    /// Change of the tip's direction of motion for a change of deflection, rad.
    #[inline]
    pub(super) fn turn(&self, change: f64) -> f64 {
        self.shortening * change
    }

    /// What of the shaft has no inertia here, in series with a surface of this
    /// compliance, m/N.
    #[inline]
    pub(super) fn give(&self, surface: f64) -> Give {
        Give {
            across: surface + self.residual_tip,
            along: surface + self.axial,
        }
    }

    /// Deflections under a force on the tip, with the residual part, m.
    pub(super) fn deflection(&self, state: &State, force: [f64; 2]) -> [f64; 2] {
        let [u, v] = self.deflections(state);
        [
            u + self.residual_tip * force[0],
            v + self.residual_tip * force[1],
        ]
    }

    /// Rotation of the base, rad.
    #[inline]
    pub(super) fn rotation(&self, state: &State, force: [f64; 2]) -> [f64; 2] {
        let of = |axis: &[Resonator; MODES], force: f64| -> f64 {
            let terms = axis
                .iter()
                .zip(&self.base)
                .map(|(mode, base)| base * mode.x);
            terms.sum::<f64>() + self.residual_base * force
        };
        [of(&state.axes[0], force[0]), of(&state.axes[1], force[1])]
    }

    /// At rest under the static force that brings the modal tip to u.
    pub(super) fn bent(&self, tip_m: [f64; 2]) -> State {
        let give = |k: usize| self.tip[k] / (self.omega[k] * self.omega[k]);
        let whole: f64 = (0..MODES).map(|k| self.tip[k] * give(k)).sum();
        let axis = |u: f64| {
            core::array::from_fn(|k| Resonator {
                x: u / whole * give(k),
                v: 0.0,
            })
        };
        State {
            axes: tip_m.map(axis),
        }
    }
}

/// How modes move in a part of a step.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Reach {
    over: [Propagator; MODES],
    /// Amplitude and rate at the end for a force of 1 N on the tip.
    push: [[f64; 2]; MODES],
    /// Displacement of the modal tip for it, m/N.
    pub(super) response: f64,
}

impl Reach {
    pub(super) fn new(shape: &Shape, dt_s: f64) -> Self {
        let over = shape
            .omega
            .map(|omega| Propagator::new(omega / TAU, shape.damping, dt_s));
        let push: [[f64; 2]; MODES] = core::array::from_fn(|k| {
            let mut mode = Resonator::default();
            mode.step(&over[k], shape.tip[k] / (shape.omega[k] * shape.omega[k]));
            [mode.x, mode.v]
        });
        let response = push.iter().zip(&shape.tip).map(|(push, tip)| push[0] * tip);
        Self {
            over,
            push,
            response: response.sum(),
        }
    }
}

/// Amplitudes and rates of the modes in x and y.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct State {
    axes: [[Resonator; MODES]; 2],
}

impl State {
    /// Moves on without a force.
    #[inline]
    pub(super) fn free(&mut self, reach: &Reach) {
        for axis in &mut self.axes {
            for (mode, over) in axis.iter_mut().zip(&reach.over) {
                mode.step(over, 0.0);
            }
        }
    }

    /// Adds what a force that acted during the part has done.
    #[inline]
    pub(super) fn push(&mut self, reach: &Reach, force: [f64; 2]) {
        for (axis, force) in self.axes.iter_mut().zip(force) {
            for (mode, push) in axis.iter_mut().zip(&reach.push) {
                mode.x += push[0] * force;
                mode.v += push[1] * force;
            }
        }
    }

    /// Adds the amplitudes of another state.
    pub(super) fn lean(&mut self, more: &Self) {
        let modes = self.axes.iter_mut().flatten();
        for (mode, more) in modes.zip(more.axes.iter().flatten()) {
            mode.x += more.x;
        }
    }

    /// The base's velocity and angular velocity change along an axis.
    #[inline]
    pub(super) fn kick(&mut self, shape: &Shape, axis: usize, shift: f64, turn: f64) {
        let modes = self.axes.get_mut(axis).into_iter().flatten();
        for (mode, drive) in modes.zip(&shape.drive) {
            mode.v -= drive[0] * shift + drive[1] * turn;
        }
    }

    /// Velocity of the tip in x and y, m/s.
    #[inline]
    pub(super) fn velocity(&self, shape: &Shape) -> [f64; 2] {
        let of = |axis: &[Resonator; MODES]| -> f64 {
            let terms = axis.iter().zip(&shape.tip).map(|(mode, tip)| tip * mode.v);
            terms.sum()
        };
        [of(&self.axes[0]), of(&self.axes[1])]
    }

    /// Its size.
    pub(super) fn speed(&self, shape: &Shape) -> f64 {
        let [u, v] = self.velocity(shape);
        (u * u + v * v).sqrt()
    }

    pub(super) fn energy_j(&self, shape: &Shape) -> f64 {
        let of =
            |(mode, omega): (&Resonator, &f64)| 0.5 * (mode.v * mode.v + (omega * mode.x).powi(2));
        let axes = self.axes.iter();
        axes.map(|axis| axis.iter().zip(&shape.omega).map(of).sum::<f64>())
            .sum()
    }

    /// Cuts a deflection of the tip of more than twice the length back to that:
    /// linear theory has ended long before, and a shaft would have broken. Says
    /// whether it did.
    #[inline]
    pub(super) fn limit(&mut self, shape: &Shape) -> bool {
        let [u, v] = shape.deflections(self);
        let most = 2.0 * shape.length_m;
        let square = u * u + v * v;
        let beyond = square > most * most;
        if beyond {
            let cut = most / square.sqrt();
            for mode in self.axes.iter_mut().flatten() {
                mode.x *= cut;
                mode.v *= cut;
            }
        }
        beyond
    }

    pub(super) fn is_finite(&self) -> bool {
        let mut modes = self.axes.iter().flatten();
        modes.all(|mode| mode.x.is_finite() && mode.v.is_finite())
    }
}
