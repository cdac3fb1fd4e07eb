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

use super::vector::{V3, add, dot, scale};

/// Rounds by which the direction of sliding is found; each leaves about the
/// ratio of the response's anisotropy.
const ROUNDS: usize = 6;

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
    /// Friction up to which the tip is held, and when it slides.
    pub(super) friction: [f64; 2],
}

/// What a contact does during a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Force {
    /// N and the two components of T, N.
    pub(super) local: [f64; 3],
    /// Whether the tip is held.
    pub(super) stuck: bool,
}

impl Problem {
    /// The force, where the gap would be negative.
    #[inline]
    pub(super) fn solve(&self) -> Force {
        let held = self.stick();
        let [n, a, b] = held;
        let reach = self.friction[0] * n;
        if n >= 0.0 && a * a + b * b <= reach * reach {
            return Force {
                local: held,
                stuck: true,
            };
        }
        self.slip(held)
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
        let [normal, first, second] = self.response;
        let mu = self.friction[1];
        let own = normal[0] + self.springs[0];
        let mut way = direction([held[1], held[2]], self.stretch);
        let mut local = [-self.gap / own, 0.0, 0.0];
        for _ in 0..ROUNDS {
            let push = own + mu * (normal[1] * way[0] + normal[2] * way[1]);
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
            local = [n, mu * n * way[0], mu * n * way[1]];
            let moved = |row: [f64; 3]| row[0] * local[0] + row[1] * local[1] + row[2] * local[2];
            let end = [
                self.stretch[0] + moved(first),
                self.stretch[1] + moved(second),
            ];
            way = direction([-end[0], -end[1]], [-way[0], -way[1]]);
        }
        Force {
            local,
            stuck: false,
        }
    }
}

/// a/|a|; against `or` where a is zero.
fn direction(a: [f64; 2], or: [f64; 2]) -> [f64; 2] {
    let unit = |[x, y]: [f64; 2]| {
        let size = x.hypot(y);
        (size > 0.0).then(|| [x / size, y / size])
    };
    unit(a)
        .or_else(|| unit([-or[0], -or[1]]))
        .unwrap_or([0.0; 2])
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
