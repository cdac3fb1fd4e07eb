//! One contact over one part of a step: normal force and friction, implicit.
//!
//! Glossary:
//!
//! - *response* W: displacement of the tip at the end of the part for a force of
//!   1 N that acts all through it;
//! - *springs* 1/k: how much further a force displaces it, without inertia;
//! - *stretch* ξ: displacement of the tip along the ground from where it is held,
//!   without the force; *gap* g: its distance to the ground, likewise.
//!
//! Sought is a force that is constant during the part, with
//!
//! N ≥ 0, g + (W + 1/k) F = 0 along the normal, |T| ≤ μ N,
//!
//! and ξ + (W + 1/k) F = slip along the ground. Where T would pass the cone, the
//! tip slips against it: T · slip ≤ 0, so that friction takes energy. The energy
//! that modes and springs exchange is in the law that sets the problem.

use crate::vector::{V3, add, dot, length2, scale};

/// Most rounds of Newton's method for the direction of sliding; mostly three.
const ROUNDS: usize = 24;

/// A contact problem in a frame (normal, first tangent, second tangent).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Problem {
    /// Gap without the force, m; negative.
    pub(crate) gap: f64,
    /// Stretch without slip and without the force, m.
    pub(crate) stretch: [f64; 2],
    /// W, m/N; symmetric and positive. What differs between directions in the
    /// springs may be part of it.
    pub(crate) response: [[f64; 3]; 3],
    /// 1/k_n and 1/k_t, m/N; positive.
    pub(crate) springs: [f64; 2],
    pub(crate) friction: f64,
    /// First guess of the direction of T if the tip slides: the last one, or zero.
    pub(crate) near: [f64; 2],
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Force {
    /// N and the two components of T, N.
    pub(crate) local: [f64; 3],
    pub(crate) stuck: bool,
}

impl Problem {
    /// No force where the gap is open without one.
    #[inline]
    pub(crate) fn solve(&self) -> Force {
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
    pub(crate) fn slipped(&self, force: &Force) -> f64 {
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
    ///
    /// T = μ N e for a direction e, and so N = −g/(M_nn + μ m·e) with M = W + 1/k
    /// and m = M_nt. Sought is the e that is opposed to the slip r = ξ + m N +
    /// μ N M_tt e: the root of r·e⊥, by Newton's method on the circle, between
    /// two directions that it lies between.
    fn slip(&self, held: [f64; 3]) -> Force {
        let [[nn, na, nb], [_, aa, ab], [_, _, bb]] = self.response;
        let nn = nn + self.springs[0];
        let (aa, bb) = (aa + self.springs[1], bb + self.springs[1]);
        let mu = self.friction;
        let loose = -self.gap / nn;
        let [s, t] = self.stretch;
        let mut found = Force {
            local: [loose, 0.0, 0.0],
            stuck: false,
        };
        if mu <= 0.0 {
            return found;
        }
        let against = || [-(s + na * loose), -(t + nb * loose)];
        let Some(mut e) = direction(self.near).or_else(|| direction(against())) else {
            return found;
        };
        let (mut low, mut high) = (None, None);
        for _ in 0..ROUNDS {
            let [x, y] = e;
            let own = nn + mu * (na * x + nb * y);
            if own <= 0.01 * nn {
                // The harder it slides, the harder it is pressed: it jams.
                if held[0] > 0.0 {
                    found.local = held;
                    found.stuck = true;
                }
                return found;
            }
            let n = -self.gap / own;
            let pull = mu * n;
            let along = [aa * x + ab * y, ab * x + bb * y];
            let slip = [s + na * n + pull * along[0], t + nb * n + pull * along[1]];
            let off = slip[1] * x - slip[0] * y;
            let opposed = -(slip[0] * x + slip[1] * y);
            if opposed >= 0.0 {
                found.local = [n, pull * x, pull * y];
                if off.abs() <= 1e-9 * opposed {
                    return found;
                }
            } else if off.abs() <= -1e-3 * opposed {
                // A root at which friction would drive the tip.
                (low, high) = (None, None);
                e = [-x, -y];
                continue;
            }
            // Change of r·e⊥ as e turns.
            let steep = nb * x - na * y;
            let less = pull * steep / own * (steep + mu * (along[1] * x - along[0] * y));
            let turned = bb * x * x + aa * y * y - 2.0 * ab * x * y;
            let change = opposed + pull * turned - less;
            if off < 0.0 {
                low = Some(e);
            } else {
                high = Some(e);
            }
            let step = if change > off.abs() {
                -off / change
            } else {
                -off.signum()
            };
            let next = direction([x - step * y, y + step * x]).unwrap_or(e);
            e = match (low, high) {
                (Some(low), Some(high)) if cross(low, next) <= 0.0 || cross(next, high) <= 0.0 => {
                    direction([low[0] + high[0], low[1] + high[1]]).unwrap_or(next)
                }
                _ => next,
            };
        }
        // The last force that takes energy, or no friction.
        found
    }
}

#[inline]
fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// The direction of a vector that has one.
#[inline]
fn direction(v: [f64; 2]) -> Option<[f64; 2]> {
    let size = length2(v);
    (size > 0.0).then(|| [v[0] / size, v[1] / size])
}

/// Axes of a contact in the plate's coordinates: the normal of a ground with the
/// slopes (h₁, h₂), and two tangents.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Frame {
    pub(crate) axes: [V3; 3],
    /// Cosine of the ground's slope: a height above the ground times it is the
    /// distance to it.
    pub(crate) upright: f64,
}

impl Frame {
    #[inline]
    pub(crate) fn new(slopes: [f64; 2]) -> Self {
        let [p, q] = slopes;
        let upright = 1.0 / (1.0 + p * p + q * q).sqrt();
        let normal = [-p * upright, -q * upright, upright];
        // Up the first coordinate, and across: normal × first.
        let level = 1.0 / (1.0 + p * p).sqrt();
        let first = [level, 0.0, p * level];
        let second = crate::vector::cross(normal, first);
        Self {
            axes: [normal, first, second],
            upright,
        }
    }

    #[inline]
    pub(crate) fn local(&self, v: V3) -> [f64; 3] {
        self.axes.map(|axis| dot(axis, v))
    }

    #[inline]
    pub(crate) fn plate(&self, local: [f64; 3]) -> V3 {
        let [n, a, b] = self.axes;
        add(add(scale(local[0], n), local[1], a), local[2], b)
    }
}

#[cfg(test)]
mod tests;
