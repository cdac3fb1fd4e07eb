//! Where a plate ends, and bars: what a whisker touches that is no endless plane.
//!
//! Glossary:
//!
//! - *u*, *w*: coordinates of the plate along it and above its plane; what follows is the same
//!   at every place across it;
//! - *core*: a segment of a line in the depth of the radius r below the plane. The body is all
//!   that is within r of it: a plate of thickness 2r with rounded ends, or, where the core is a
//!   point, a round bar;
//! - *tangent plane*: the plane on the body at the place that is nearest to the shaft.
//!
//! In a part of a step the shaft touches the tangent plane in place of the body, whose surface
//! falls away from it by d²/2r at a distance d: so contact is the same for all bodies. Places on
//! the surface are arc lengths along the outline, which agree with u where it is flat.

use crate::pose::PlatePose;
use crate::vector::{V3, add, dot};

/// The outline of a plate across its first coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outline {
    /// Where the flat part begins and ends along the plate, m; infinite: nowhere.
    pub flat_m: [f64; 2],
    /// Radius of the rounding beyond, 1e-4 to 1 m: half the thickness.
    pub radius_m: f64,
}

impl Outline {
    /// An endless plate.
    pub const PLANE: Self = Self {
        flat_m: [f64::NEG_INFINITY, f64::INFINITY],
        radius_m: 1.0,
    };

    /// A plate whose flat part ends at `end_m`.
    pub const fn edge(end_m: f64, radius_m: f64) -> Self {
        Self {
            flat_m: [f64::NEG_INFINITY, end_m],
            radius_m,
        }
    }

    /// A round bar across the plate's first coordinate; it touches the plane at the origin.
    pub const fn bar(radius_m: f64) -> Self {
        Self {
            flat_m: [0.0; 2],
            radius_m,
        }
    }

    #[inline]
    pub(crate) fn is_plane(&self) -> bool {
        self.flat_m[0] == f64::NEG_INFINITY && self.flat_m[1] == f64::INFINITY
    }

    /// With its radius within the range; what has no outline that can be drawn is a plane.
    pub(crate) fn limited(self) -> Self {
        let [low, high] = self.flat_m;
        let drawn = low <= high && low < f64::INFINITY && high > f64::NEG_INFINITY;
        if drawn && self.radius_m > 0.0 {
            Self {
                radius_m: self.radius_m.clamp(1e-4, 1.0),
                ..self
            }
        } else {
            Self::PLANE
        }
    }

    /// The tangent plane on the place that is nearest to a point.
    pub(crate) fn tangent(&self, [u, _, w]: V3) -> Tangent {
        let r = self.radius_m;
        let [low, high] = self.flat_m;
        let core = u.max(low).min(high);
        let (du, dw) = (u - core, w + r);
        let far = (du * du + dw * dw).sqrt();
        // A point of the core itself has no nearest place: above it, as good as any.
        let (sine, cosine) = if far > 1e-12 {
            (du / far, dw / far)
        } else {
            (0.0, 1.0)
        };
        let turned = libm::atan2(sine, cosine);
        // The underside is reached around an end.
        let along = if cosine < 0.0 {
            2.0 * if sine < 0.0 || high.is_infinite() {
                low
            } else {
                high
            } - core
        } else {
            core
        };
        Tangent {
            sine,
            cosine,
            touch: [core + r * sine, r * cosine - r],
            at_m: along + r * turned,
            above_m: far - r,
            flat_m: if du == 0.0 && cosine > 0.0 {
                [low - core, high - core]
            } else {
                [0.0; 2]
            },
            radius_m: r,
        }
    }
}

/// A plane on a body, and how its surface falls away from it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tangent {
    /// Of the angle by which its normal is turned towards the plate's end.
    sine: f64,
    cosine: f64,
    /// Where it touches the body, u and w, m.
    touch: [f64; 2],
    /// The same as an arc length.
    at_m: f64,
    /// How high the point is over it, m.
    pub(crate) above_m: f64,
    /// From where to where the body is flat, from where it touches, m; beyond it is round.
    flat_m: [f64; 2],
    radius_m: f64,
}

impl Tangent {
    /// Its normal, in the plate's coordinates.
    pub(crate) fn up(&self) -> V3 {
        [self.sine, 0.0, self.cosine]
    }

    /// How fast a way in the plate's coordinates leaves the body, and what that grows by along
    /// it, 1/m, where the body is round: of half the square of the distance from the core, by that
    /// distance, so that of a straight way the nearest place is where Newton's method goes.
    pub(crate) fn leaves(&self, way: V3) -> [f64; 2] {
        let far_m = self.above_m + self.radius_m;
        let grows = if self.is_round() && far_m > 0.0 {
            (way[0] * way[0] + way[2] * way[2]) / far_m
        } else {
            0.0
        };
        [dot(self.up(), way), grows]
    }

    /// By how much another place may be deeper before it takes over, of at most `most_m`: none
    /// is to pass the core.
    pub(crate) fn deeper_m(&self, most_m: f64) -> f64 {
        if self.is_round() {
            most_m.min(0.25 * self.radius_m)
        } else {
            most_m
        }
    }

    /// A pose in the coordinates of this plane: arc length, across, above.
    pub(crate) fn see(&self, pose: &PlatePose) -> PlatePose {
        let turn = |[u, v, w]: V3| {
            let along = self.cosine * u - self.sine * w;
            [along, v, self.sine * u + self.cosine * w]
        };
        let [u, w] = self.touch;
        PlatePose {
            base: add(
                turn(add(pose.base, -1.0, [u, 0.0, w])),
                self.at_m,
                [1.0, 0.0, 0.0],
            ),
            x: turn(pose.x),
            y: turn(pose.y),
            z: turn(pose.z),
        }
    }

    fn is_round(&self) -> bool {
        self.flat_m[0] == self.flat_m[1]
    }

    /// Slope of the surface at a place, and its change, 1/m.
    #[inline]
    pub(crate) fn falls(&self, along_m: f64) -> [f64; 2] {
        let [low, high] = self.flat_m;
        let off_m = along_m - self.at_m;
        let beyond_m = off_m - off_m.max(low).min(high);
        let bow = if beyond_m != 0.0 || self.is_round() {
            1.0 / self.radius_m
        } else {
            0.0
        };
        // Not farther than a round body has a surface.
        let beyond_m = beyond_m.clamp(-self.radius_m, self.radius_m);
        [-bow * beyond_m, -bow]
    }

    /// The nearest place that has a surface.
    #[inline]
    pub(crate) fn on(&self, along_m: f64) -> f64 {
        let [low, high] = self.flat_m;
        let off_m = along_m - self.at_m;
        self.at_m + off_m.max(low - self.radius_m).min(high + self.radius_m)
    }

    /// Height and slopes of the ground at a place of the surface.
    #[inline]
    pub(crate) fn bowed(&self, [height, along, across]: [f64; 3], along_m: f64) -> [f64; 3] {
        let [slope, _] = self.falls(along_m);
        [
            height - 0.5 * self.radius_m * slope * slope,
            along + slope,
            across,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::Outline;
    use crate::pose::PlatePose;

    const UPRIGHT: PlatePose = PlatePose {
        base: [0.0; 3],
        x: [1.0, 0.0, 0.0],
        y: [0.0, 1.0, 0.0],
        z: [0.0, 0.0, 1.0],
    };

    /// The point, seen from the plane on the place nearest to it.
    fn seen(outline: Outline, point: [f64; 3]) -> [f64; 3] {
        let pose = PlatePose {
            base: point,
            ..UPRIGHT
        };
        outline.tangent(point).see(&pose).base
    }

    #[test]
    fn a_point_is_over_the_nearest_place_by_its_distance() {
        let bar = Outline::bar(2e-3);
        let edge = Outline::edge(5e-3, 1e-3);
        let quarter = core::f64::consts::FRAC_PI_2;
        for (outline, point, [along, above]) in [
            (bar, [0.0, 0.3, 1e-3], [0.0, 1e-3]),
            // Beside the bar's axis, 3 mm from it.
            (bar, [3e-3, 0.3, -2e-3], [2e-3 * quarter, 1e-3]),
            (bar, [-3e-3, 0.3, -2e-3], [-2e-3 * quarter, 1e-3]),
            (edge, [2e-3, 0.3, 1e-3], [2e-3, 1e-3]),
            (edge, [7e-3, 0.3, -1e-3], [5e-3 + 1e-3 * quarter, 1e-3]),
            // Below: around the end and back.
            (edge, [4e-3, 0.3, -4e-3], [6e-3 + 2e-3 * quarter, 2e-3]),
            (edge, [4e-3, 0.3, -0.5e-3], [4e-3, -0.5e-3]),
        ] {
            let [u, v, w] = seen(outline, point);
            assert!((u - along).abs() < 1e-15, "{outline:?} {point:?} {u}");
            assert!((w - above).abs() < 1e-15, "{outline:?} {point:?} {w}");
            assert_eq!(v, 0.3);
        }
    }

    #[test]
    fn what_cannot_be_drawn_is_a_plane() {
        for outline in [
            Outline::edge(f64::NAN, 1e-3),
            Outline::edge(0.0, f64::NAN),
            Outline::edge(f64::NEG_INFINITY, 1e-3),
            Outline {
                flat_m: [1.0, 0.0],
                radius_m: 1e-3,
            },
        ] {
            assert!(outline.limited().is_plane(), "{outline:?}");
        }
        assert_eq!(Outline::bar(1e-9).limited().radius_m, 1e-4);
    }
}
