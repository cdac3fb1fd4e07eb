//! The law of a part: the force that acts during it.
//!
//! The force F is constant during a part of the length h and is that of the
//! stretches ξ at its start and end, weighted, and of a damper beside the spring:
//!
//! −C F = w ξ₁ + (1 − w) ξ₀ + τ (ξ₁ − ξ₀)/h,  ½ ≤ w < 1
//!
//! with the compliance C and the lag τ of [`crate::compliance`]. With s = w + τ/h that is
//! −C F = s ξ₁ + (1 − s) ξ₀. The end is ξ₁ = ξ₀ + Δ + W F − slip, with the displacement Δ
//! of the tip without a force and the response W of the modes, and so
//!
//! (W + C/s) F + ξ₀/s + Δ = slip,
//!
//! which [`crate::contact`] solves. A foot that touches down late, for a
//! share l of the part, has ξ₀ = 0, a gap to close first, and s = l w + τ/h; for
//! w = ½ this is the mean of a force that grows evenly from then on. A foot in
//! the air has F = 0, and so ξ₁ = (1 − 1/s) ξ₀; zero where s < 1.
//!
//! # Energy
//!
//! The spring gains ½ (ξ₁ + ξ₀)·C⁻¹(ξ₁ − ξ₀), the force does the work
//! F·(ξ₁ − ξ₀ + slip).
//! The sum is −(s − ½) (ξ₁ − ξ₀)·C⁻¹(ξ₁ − ξ₀) + F·slip, and neither is positive.
//! Friction on a foot that touches down might still give energy; that part is then
//! solved without friction. So might the stretch that another place has left; there is then no
//! force.

use super::body::Body;
use crate::compliance::Compliance;
use crate::contact::{Force, Frame, Problem};
use crate::modal::ModalStep;
use crate::outline::Tangent;
use crate::pose::PlatePose;
use crate::shapes::{Amplitudes, Curve, SHAPES, Ways};
use crate::vector::{V3, add, dot, length2, scale};

/// Least share of a part after touching down: keeps quotients finite.
const LATEST: f64 = 1e-9;

/// What is known of a part before its force is.
#[derive(Clone)]
pub(super) struct Part<'a> {
    /// The poses at its start and at its end.
    pub(super) old: &'a PlatePose,
    pub(super) pose: &'a PlatePose,
    /// How the shaft is bent at its start.
    pub(super) before: &'a Curve,
    pub(super) dt_s: f64,
    pub(super) law: Law,
    /// In contact at the start; `friction` is the coefficient that then holds, from
    /// the sliding speed of the last part.
    pub(super) touching: bool,
    pub(super) friction: f64,
    /// Amplitudes at the start, and at the end without a force.
    pub(super) start: Amplitudes,
    pub(super) free: Amplitudes,
    /// Amplitude of each shape for a force of 1 on it.
    pub(super) responses: [f64; SHAPES],
    /// Displacement of the tip by the modes for 1 N on it, m.
    pub(super) response: f64,
    /// Stretch at the start, turned with the base.
    pub(super) stretch: V3,
    /// The foot at the start and the ground there.
    pub(super) foot: V3,
    pub(super) ground: [f64; 3],
    /// How the base carries the place away from the foot.
    pub(super) carried: V3,
    /// The plane that the poses are seen from, where it is not the plate's own.
    pub(super) tangent: Option<Tangent>,
}

/// A part that has been solved on a plane.
#[derive(Clone)]
pub(super) struct Solved {
    pub(super) frame: Frame,
    pub(super) problem: Problem,
    pub(super) force: Force,
    /// At the end, plate coordinates, m.
    pub(super) stretch: V3,
    /// Energy of the spring at the start less the work on the shaft, J.
    pub(super) left_j: f64,
}

/// How the shapes move a place of the shaft, along x, y and z.
#[derive(Clone)]
pub(super) struct Moves {
    pub(super) ways: Ways,
    /// Displacement without a force.
    free: V3,
    /// W, m/N.
    response: [V3; 3],
}

impl Moves {
    #[inline]
    pub(super) fn new(ways: &Ways, part: &Part<'_>) -> Self {
        let mut free = [0.0; 3];
        let (mut xx, mut xy, mut xz) = (0.0, 0.0, 0.0);
        let (mut yy, mut yz, mut zz) = (0.0, 0.0, 0.0);
        for k in 0..SHAPES {
            let (end, start, own) = (&part.free[k], &part.start[k], part.responses[k]);
            for (axis, way) in ways.of(k).into_iter().enumerate() {
                free = add(free, end[axis] - start[axis], way);
                let [x, y, z] = way;
                let pushed = scale(own, way);
                xx += x * pushed[0];
                xy += x * pushed[1];
                xz += x * pushed[2];
                yy += y * pushed[1];
                yz += y * pushed[2];
                zz += z * pushed[2];
            }
        }
        Self {
            ways: *ways,
            free,
            response: [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]],
        }
    }

    #[inline]
    pub(super) fn between(&self, start: &Amplitudes, end: &Amplitudes) -> V3 {
        let mut moved = [0.0; 3];
        for k in 0..SHAPES {
            for (axis, way) in self.ways.of(k).into_iter().enumerate() {
                moved = add(moved, end[k][axis] - start[k][axis], way);
            }
        }
        moved
    }

    /// Displacement under a force along x, y and z.
    #[inline]
    pub(super) fn under(&self, force: V3) -> V3 {
        core::array::from_fn(|i| self.free[i] + dot(self.response[i], force))
    }

    /// How much more a shaft rises at the place per metre that a force of 1 N along `up` moves
    /// along it, 1/(N m): what its shapes give way by to the place's way and the
    /// tangent's turn, less what the force decreases by.
    #[inline]
    pub(super) fn turned(&self, turns: &Ways, up: V3, responses: &[f64; SHAPES]) -> f64 {
        let (ways, turns) = (self.ways.towards(up), turns.towards(up));
        let (mut far, mut both, mut steep) = (0.0, 0.0, 0.0);
        for ((ways, turns), response) in ways.iter().zip(turns).zip(responses) {
            for (way, turn) in ways.iter().zip(turns) {
                far += response * way * way;
                both += response * way * turn;
                steep += response * turn * turn;
            }
        }
        if far > 0.0 {
            steep - both * both / far
        } else {
            0.0
        }
    }

    /// What a force along x, y and z is on each shape.
    #[inline]
    pub(super) fn forces(&self, force: V3) -> Amplitudes {
        self.ways.towards(force)
    }
}

/// The constants of the law for parts of one length.
#[derive(Clone, Copy)]
pub(super) struct Law {
    pub(super) compliance: Compliance,
    /// w.
    weight: f64,
    /// τ/h.
    lag: f64,
}

impl Law {
    /// s of a part in contact for a share of it.
    #[inline]
    pub(super) fn share(&self, late: f64) -> f64 {
        late * self.weight + self.lag
    }

    /// The part of a stretch that a part without a force leaves: F = 0 in the law.
    #[inline]
    pub(super) fn kept(&self) -> f64 {
        kept(self.share(1.0))
    }
}

#[inline]
fn kept(share: f64) -> f64 {
    (1.0 - 1.0 / share).max(0.0)
}

impl Body {
    #[inline]
    pub(super) fn law(&self, step: &ModalStep, part_s: f64) -> Law {
        let compliance = self.shaft.compliance(self.ground.compliance_m_n);
        let lag_s = compliance.lag_s(self.ground.surface.damping, self.shaft.mobility);
        Law {
            compliance,
            weight: compliance.weight(step.response),
            lag: lag_s / part_s,
        }
    }

    /// The force on a plane, for a place that is moved so.
    #[inline]
    pub(super) fn solve(&self, part: &Part<'_>, frame: Frame, moves: &Moves) -> Solved {
        let compliance = &part.law.compliance;
        // The frame's axes along x, y and z.
        let axes = frame.axes.map(|axis| part.pose.components(axis));
        let pushed = axes.map(|axis| moves.response.map(|row| dot(row, axis)));
        let free = axes.map(|axis| dot(axis, moves.free));
        let moved = add(frame.local(part.carried), 1.0, free);
        let begin = frame.local(part.stretch);
        let above = (part.foot[2] - part.ground[0]) * frame.upright;
        let below = above.min(0.0);
        let above = above.max(0.0);
        // The share of the part after it touches down.
        let late = if moved[0] < 0.0 && !part.touching {
            (1.0 + above / moved[0]).clamp(LATEST, 1.0)
        } else {
            1.0
        };
        let share = part.law.share(late);
        let friction = if part.touching {
            part.friction
        } else {
            let sliding_m_s = length2([moved[1], moved[2]]) / part.dt_s;
            self.ground.surface.friction_at(sliding_m_s)
        };
        let along = frame.local(part.pose.z);
        let given: [V3; 3] =
            core::array::from_fn(|i| core::array::from_fn(|j| compliance.at(along, i, j)));
        let least = compliance.least();
        let entry = |i: usize, j: usize| {
            let own = if i == j { least } else { 0.0 };
            dot(axes[i], pushed[j]) + (given[i][j] - own) / share
        };
        let mut problem = Problem {
            gap: above + below + begin[0] / share + moved[0],
            stretch: [1, 2].map(|i| begin[i] / share + late * moved[i]),
            response: core::array::from_fn(|i| core::array::from_fn(|j| entry(i, j))),
            springs: [least / share; 2],
            friction,
            near: [1, 2].map(|i| dot(frame.axes[i], self.touch.force)),
        };
        let left = |force: &Force| {
            let [a, b, c] = force.local;
            let way = add(add(scale(a, pushed[0]), b, pushed[1]), c, pushed[2]);
            let along = add(add(scale(a, axes[0]), b, axes[1]), c, axes[2]);
            self.touch.spring_j - dot(force.local, moved) - dot(along, way)
        };
        let mut force = problem.solve();
        let mut left_j = left(&force);
        if left_j < 0.0 && below < 0.0 {
            // Too little energy to rise to the ground: as far as it reaches, or not at all.
            let missing_j = left_j;
            problem.gap -= below;
            let flat = problem.solve();
            let flat_j = left(&flat);
            (force, left_j) = (flat, flat_j);
            if flat_j > 0.0 {
                let share = 0.5 * flat_j / (flat_j - missing_j);
                problem.gap += share * below;
                let some = problem.solve();
                let some_j = left(&some);
                if some_j >= 0.0 {
                    (force, left_j) = (some, some_j);
                } else {
                    problem.gap -= share * below;
                }
            }
        }
        if left_j < 0.0 {
            // A place that slides before it touches down can end up here; without
            // friction it cannot.
            problem.friction = 0.0;
            force = problem.solve();
            left_j = left(&force);
        }
        if left_j < 0.0 {
            // One with the stretch of another place, that does not reach the ground.
            force = Force::default();
            left_j = self.touch.spring_j;
        }
        let stretch = if force.local[0] > 0.0 {
            core::array::from_fn(|i| {
                let given: f64 = (0..3).map(|j| given[i][j] * force.local[j]).sum();
                begin[i] - (begin[i] + given) / share
            })
        } else {
            begin.map(|b| kept(share) * b)
        };
        Solved {
            frame,
            problem,
            force,
            stretch: frame.plate(stretch),
            left_j,
        }
    }
}
