//! Amplitudes of a whisker's shapes, and how they move in a part of a step.
//!
//! A part is under a force that is constant during it. With f_k what it does to the
//! shape k, a mode is propagated exactly; a static shape, whose energy is ½ a², follows
//!
//! f_k = s a₁ + (1 − s) a₀,  s ≥ ½,
//!
//! so that f_k (a₁ − a₀) = ½ a₁² − ½ a₀² + (s − ½) (a₁ − a₀)²: the force's work covers what it
//! stores, as it does for a mode.

use core::f64::consts::TAU;

use crate::beam::{BendingMode, Modes};
use crate::compliance::Compliance;
use crate::grid::Grid;
use crate::resonator::{Propagator, Resonator};
use crate::shaft::Shaft;
use crate::shapes::{Amplitudes, Curve, MODES, SHAPES, Shapes};
use crate::vector::length2;

/// ψ at the tip up to which a shaft bends, rad: just below where directions end.
const MOST_RAD: f64 = 3.9;

#[derive(Debug, Clone)]
pub(crate) struct ModalShaft {
    pub(crate) length_m: f64,
    pub(crate) tip_radius_m: f64,
    pub(crate) grid: Grid,
    pub(crate) shapes: Shapes,
    omega: [f64; MODES],
    damping: f64,
    /// Change of rate of each mode, with a minus, for a change of the base's
    /// velocity by 1 m/s and of its angular velocity by 1 rad/s.
    drive: [[f64; 2]; MODES],
    /// Of the tip under a static force, m/N: of all shapes, and of the static ones.
    give: f64,
    rest: f64,
    /// Compliance along the shaft, m/N.
    axial: f64,
    /// Σ φ_k(L)², 1/kg: velocity of the tip for an impulse on it.
    pub(crate) mobility: f64,
    pub(crate) highest_rad_s: f64,
}

impl ModalShaft {
    pub(crate) fn new(shaft: &Shaft, modes: &Modes) -> Self {
        let of = |k: usize| modes.modes.get(k).copied();
        let part = |k: usize, value: fn(BendingMode) -> f64| of(k).map_or(0.0, value);
        // A mode that is missing has no shape; any frequency does for it.
        let omega: [f64; MODES] = core::array::from_fn(|k| of(k).map_or(1.0, |m| m.omega_rad_s));
        let mut shapes = modes.shapes;
        for k in modes.modes.len().min(MODES)..MODES {
            shapes.clear(k);
        }
        let square = |k: usize| shapes.tip[k] * shapes.tip[k];
        let moving = (0..MODES).map(|k| square(k) / (omega[k] * omega[k]));
        let rest: f64 = (MODES..SHAPES).map(square).sum();
        Self {
            length_m: shaft.length_m,
            tip_radius_m: shaft.tip_diameter_m / 2.0,
            grid: Grid::new(shaft.length_m),
            omega,
            damping: shaft.damping,
            drive: core::array::from_fn(|k| [part(k, |m| m.translation), part(k, |m| m.rotation)]),
            give: moving.sum::<f64>() + rest,
            rest,
            axial: 1.0 / shaft.follicle.axial_n_m,
            mobility: (0..MODES).map(square).sum(),
            highest_rad_s: omega.iter().copied().fold(0.0, f64::max),
            shapes,
        }
    }

    /// The massless compliance along the shaft and that of a surface, m/N.
    #[inline]
    pub(crate) fn compliance(&self, surface_m_n: f64) -> Compliance {
        Compliance {
            across: surface_m_n,
            along: surface_m_n + self.axial,
            rest: surface_m_n + self.rest,
        }
    }

    /// At rest under the static force on the tip that would bring it to u if deflections were
    /// small.
    pub(crate) fn bent(&self, tip_m: [f64; 2]) -> ModalState {
        let stiffness = |k: usize| {
            let omega = self.omega.get(k).copied().unwrap_or(1.0);
            omega * omega
        };
        let of = |k: usize| tip_m.map(|u| u / self.give * self.shapes.tip[k] / stiffness(k));
        ModalState {
            x: core::array::from_fn(of),
            v: [[0.0; 2]; MODES],
        }
    }
}

/// How shapes move in one part of a step.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ModalStep {
    over: [Propagator; MODES],
    /// Amplitude and rate at the end for a force of 1 on a mode.
    push: [[f64; 2]; MODES],
    /// Displacement of the tip by the modes for 1 N on it, m.
    pub(crate) response: f64,
}

impl ModalStep {
    pub(crate) fn new(shaft: &ModalShaft, dt_s: f64) -> Self {
        let over = shaft
            .omega
            .map(|omega| Propagator::new(omega / TAU, shaft.damping, dt_s));
        let push: [[f64; 2]; MODES] = core::array::from_fn(|k| {
            let mut mode = Resonator::default();
            mode.step(&over[k], 1.0 / (shaft.omega[k] * shaft.omega[k]));
            [mode.x, mode.v]
        });
        let response = push.iter().zip(&shaft.shapes.tip);
        Self {
            over,
            push,
            response: response.map(|(push, tip)| push[0] * tip * tip).sum(),
        }
    }

    /// Amplitude of each shape at the end for a force of 1 on it, with s of the static ones.
    #[inline]
    pub(crate) fn responses(&self, share: f64) -> [f64; SHAPES] {
        let fixed = 1.0 / share;
        core::array::from_fn(|k| self.push.get(k).map_or(fixed, |push| push[0]))
    }
}

/// Amplitudes and rates of the shapes. The two axes stand side by side, so that
/// they are computed together.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ModalState {
    /// q of each mode in x and y, m √kg, and of each static shape, √J.
    pub(crate) x: Amplitudes,
    /// Rates of the modes, m √kg/s.
    v: [[f64; 2]; MODES],
}

impl ModalState {
    #[inline]
    pub(crate) fn free(&mut self, step: &ModalStep) {
        for ((x, v), over) in self.x.iter_mut().zip(&mut self.v).zip(&step.over) {
            for (x, v) in x.iter_mut().zip(v) {
                [*x, *v] = over.apply(*x, *v, 0.0);
            }
        }
    }

    /// Leaves this part of the static shapes.
    #[inline]
    pub(crate) fn keep(&mut self, share: f64) {
        for x in self.x.iter_mut().skip(MODES).flatten() {
            *x *= share;
        }
    }

    /// Adds the effect of forces on the shapes during the part, with their responses.
    #[inline]
    pub(crate) fn push(
        &mut self,
        step: &ModalStep,
        responses: &[f64; SHAPES],
        forces: &Amplitudes,
    ) {
        self.x = pushed(&self.x, responses, forces);
        for ((v, push), force) in self.v.iter_mut().zip(&step.push).zip(forces) {
            for (v, force) in v.iter_mut().zip(force) {
                *v += push[1] * force;
            }
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

    /// Moves the modes as a static force would that moves a place by its ways as `far`, m.
    pub(crate) fn lean(&mut self, shaft: &ModalShaft, ways: &Amplitudes, far: f64) {
        let give = |k: usize| 1.0 / (shaft.omega[k] * shaft.omega[k]);
        let whole: f64 = (0..MODES)
            .map(|k| give(k) * (ways[k][0] * ways[k][0] + ways[k][1] * ways[k][1]))
            .sum();
        if whole > 0.0 {
            for (k, x) in self.x.iter_mut().take(MODES).enumerate() {
                for (x, way) in x.iter_mut().zip(ways[k]) {
                    *x += far / whole * give(k) * way;
                }
            }
        }
    }

    /// Speed of the tip across a straight shaft, m/s.
    #[inline]
    pub(crate) fn speed(&self, shaft: &ModalShaft) -> f64 {
        let along = |axis: usize| -> f64 {
            let terms = self.v.iter().zip(&shaft.shapes.tip);
            terms.map(|(v, tip)| v[axis] * tip).sum()
        };
        length2([along(0), along(1)])
    }

    #[inline]
    pub(crate) fn curve(&self, shaft: &ModalShaft) -> Curve {
        shaft.shapes.curve(&self.x)
    }

    /// No place of the shaft is further from where it would be if it were straight, m: as far
    /// as the elastic energy brings a place of the tip by any force, which bends it most.
    #[inline]
    pub(crate) fn reach_m(&self, shaft: &ModalShaft) -> f64 {
        (2.0 * self.elastic_j(shaft) * shaft.give).sqrt()
    }

    #[inline]
    fn elastic_j(&self, shaft: &ModalShaft) -> f64 {
        let square = |k: usize| self.x[k][0] * self.x[k][0] + self.x[k][1] * self.x[k][1];
        let moving = (0..MODES).map(|k| shaft.omega[k] * shaft.omega[k] * square(k));
        0.5 * (moving.sum::<f64>() + (MODES..SHAPES).map(square).sum::<f64>())
    }

    pub(crate) fn energy_j(&self, shaft: &ModalShaft) -> f64 {
        let moving = self.v.iter().flatten().map(|v| 0.5 * v * v);
        moving.sum::<f64>() + self.elastic_j(shaft)
    }

    /// Cuts a bend of the tip by more than 3.9 rad back to that: a shaft would have broken.
    /// Says whether it did.
    #[inline]
    pub(crate) fn limit(&mut self, shaft: &ModalShaft) -> bool {
        let [x, y] = shaft.shapes.turned(&self.x);
        let square = x * x + y * y;
        let beyond = square > MOST_RAD * MOST_RAD;
        if beyond {
            let cut = MOST_RAD / square.sqrt();
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

#[inline]
pub(crate) fn pushed(
    from: &Amplitudes,
    responses: &[f64; SHAPES],
    forces: &Amplitudes,
) -> Amplitudes {
    core::array::from_fn(|k| [0, 1].map(|axis| from[k][axis] + responses[k] * forces[k][axis]))
}
