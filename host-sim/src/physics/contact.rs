//! One contact over one step: normal force and friction, implicit.
//!
//! Glossary:
//!
//! - *response* W: displacement of the tip at the end of the step for a force of
//!   1 N that acts all through it;
//! - *springs*: the surface in series with the part of the shaft that has no
//!   inertia here (residual modes, length), one normal and one tangential;
//! - *stretch* ξ: elongation of the tangential spring, from the place where the
//!   surface holds it to the tip.
//!
//! Sought is a force that is constant during the step and meets at its end
//!
//! N = max(0, −k_n g), |T| ≤ μ N, T = −k_t ξ,
//!
//! with the gap g and stretch ξ that it brings about itself. Where T would pass
//! the cone, the surface lets go until it lies on it, opposed to the sliding.
//!
//! # Energy
//!
//! A constant force does the work F·Δp exactly, and the springs' energies are
//! convex, so what they take is at least what their force at the end of the step
//! does: modes and springs together gain nothing, at any stiffness and any
//! length of the step. What slips is lost.

use super::vector::{V3, add, dot, length2, scale};

/// Rounds by which the size of the normal force and the direction of sliding are
/// found, at most.
const ROUNDS: usize = 8;

/// A contact problem in a frame (normal, first tangent, second tangent).
#[derive(Debug, Clone, Copy)]
pub(super) struct Problem {
    /// Gap without the force, m; negative.
    pub(super) gap: f64,
    /// Stretch without slip and without the force, m.
    pub(super) stretch: [f64; 2],
    /// W, m/N; symmetric and positive.
    pub(super) response: [[f64; 3]; 3],
    /// 1/k_n and 1/k_t, m/N; positive.
    pub(super) springs: [f64; 2],
    /// Coefficient of friction μ.
    pub(super) friction: f64,
}

/// What a contact does during a step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Force {
    /// N and the two components of T, N.
    pub(super) local: [f64; 3],
    /// Whether the tip is held.
    pub(super) stuck: bool,
}

impl Problem {
    /// The force; none where the gap is open without one.
    #[inline]
    pub(super) fn solve(&self) -> Force {
        if self.gap >= 0.0 {
            return Force::default();
        }
        let held = self.stick();
        let [n, a, b] = held;
        let reach = self.friction * n;
        if n >= 0.0 && a * a + b * b <= reach * reach {
            return Force {
                local: held,
                stuck: true,
            };
        }
        self.slip(held)
    }

    /// How far the tip has slid under a force, m.
    #[inline]
    pub(super) fn slipped(&self, force: &Force) -> f64 {
        if force.stuck {
            return 0.0;
        }
        let [n, a, b] = force.local;
        let [_, [na, aa, ab], [nb, _, bb]] = self.response;
        let spring = self.springs[1];
        let first = self.stretch[0] + na * n + (aa + spring) * a + ab * b;
        let second = self.stretch[1] + nb * n + ab * a + (bb + spring) * b;
        length2([first, second])
    }

    /// The force that holds the tip: (W + 1/k) F = −(g, ξ), by Cramer's rule.
    fn stick(&self) -> [f64; 3] {
        let [[nn, na, nb], [_, aa, ab], [_, _, bb]] = self.response;
        let (nn, aa, bb) = (
            nn + self.springs[0],
            aa + self.springs[1],
            bb + self.springs[1],
        );
        let (c0, c1, c2) = (aa * bb - ab * ab, ab * nb - na * bb, na * ab - aa * nb);
        let inverse = -1.0 / (nn * c0 + na * c1 + nb * c2);
        let (d11, d12, d22) = (nn * bb - nb * nb, na * nb - nn * ab, nn * aa - na * na);
        let (g, [s, t]) = (self.gap, self.stretch);
        [
            inverse * (c0 * g + c1 * s + c2 * t),
            inverse * (c1 * g + d11 * s + d12 * t),
            inverse * (c2 * g + d12 * s + d22 * t),
        ]
    }

    /// The force on the cone, for a tip that `held` could not hold.
    fn slip(&self, held: [f64; 3]) -> Force {
        let [normal, ..] = self.response;
        let mu = self.friction;
        let own = normal[0] + self.springs[0];
        let mut local = [-self.gap / own, 0.0, 0.0];
        for _ in 0..ROUNDS {
            let [a, b] = self.drag(local);
            let share = |t: f64| if local[0] > 0.0 { t / local[0] } else { 0.0 };
            let way = [share(a), share(b)];
            let push = own + normal[1] * way[0] + normal[2] * way[1];
            if push <= 0.01 * own {
                // The harder it slides, the harder it is pressed on: it jams.
                if held[0] > 0.0 {
                    return Force {
                        local: held,
                        stuck: true,
                    };
                }
                break;
            }
            let n = -self.gap / push;
            let change = (n - local[0]).abs();
            local = [n, n * way[0], n * way[1]];
            if mu == 0.0 || change <= 1e-9 * n {
                break;
            }
        }
        Force {
            local,
            stuck: false,
        }
    }

    /// Friction under a normal force of `last`: the T of |T| ≤ μ N with the
    /// least energy. On the cone (W + 1/k + λ) T = −ξ′, so that the slip −λ T is
    /// against the force; λ by Newton's method on 1/|T|, which is concave.
    fn drag(&self, last: [f64; 3]) -> [f64; 2] {
        let n = last[0];
        let [_, [na, aa, ab], [nb, _, bb]] = self.response;
        let reach = self.friction * n;
        if reach <= 0.0 {
            return [0.0; 2];
        }
        // Principal axes of the tangential response.
        let (aa, bb) = (aa + self.springs[1], bb + self.springs[1]);
        let (half, mean) = (0.5 * (aa - bb), f64::midpoint(aa, bb));
        let spread = length2([half, ab]);
        let (c, s) = if spread > 1e-12 * mean {
            let c = (0.5 * (1.0 + half / spread)).max(0.0).sqrt();
            let s = (0.5 * (1.0 - half / spread)).max(0.0).sqrt();
            (c, s.copysign(ab))
        } else {
            (1.0, 0.0)
        };
        let give = [mean + spread, (mean - spread).max(self.springs[1])];
        let stretch = [self.stretch[0] + na * n, self.stretch[1] + nb * n];
        let pull = [
            c * stretch[0] + s * stretch[1],
            c * stretch[1] - s * stretch[0],
        ];
        let of = |more: f64| [pull[0] / (give[0] + more), pull[1] / (give[1] + more)];
        let mut more = (length2(pull) / reach - give[0]).max(0.0);
        let mut force = of(more);
        for _ in 0..ROUNDS {
            let size = length2(force);
            if size <= reach * (1.0 + 1e-9) {
                break;
            }
            let fall =
                force[0] * force[0] / (give[0] + more) + force[1] * force[1] / (give[1] + more);
            more += size * size / fall * (size / reach - 1.0);
            force = of(more);
        }
        let size = length2(force);
        let cut = if size > reach { reach / size } else { 1.0 };
        let [a, b] = force.map(|f| -cut * f);
        [c * a - s * b, s * a + c * b]
    }
}

/// Axes of a contact in the plate's coordinates: the normal of a ground with the
/// slopes (h₁, h₂), and two tangents.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    pub(super) axes: [V3; 3],
    /// Cosine of the ground's slope: a height above the ground times it is the
    /// distance to it.
    pub(super) upright: f64,
}

impl Frame {
    #[inline]
    pub(super) fn new(slopes: [f64; 2]) -> Self {
        let [p, q] = slopes;
        let upright = 1.0 / (1.0 + p * p + q * q).sqrt();
        let normal = [-p * upright, -q * upright, upright];
        // Up the first coordinate, and across: normal × first.
        let level = 1.0 / (1.0 + p * p).sqrt();
        let first = [level, 0.0, p * level];
        let second = super::vector::cross(normal, first);
        Self {
            axes: [normal, first, second],
            upright,
        }
    }

    /// Components of a vector in this frame.
    #[inline]
    pub(super) fn local(&self, v: V3) -> [f64; 3] {
        self.axes.map(|axis| dot(axis, v))
    }

    /// The vector with these components.
    #[inline]
    pub(super) fn plate(&self, local: [f64; 3]) -> V3 {
        let [n, a, b] = self.axes;
        add(add(scale(local[0], n), local[1], a), local[2], b)
    }
}

#[cfg(test)]
mod tests;
