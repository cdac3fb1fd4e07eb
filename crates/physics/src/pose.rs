//! Where a whisker is, and the flat plate that it may touch.

use super::surface::Surface;
use super::vector::{V3, across, add, cross, dot, scale, sub, unit};

/// A whisker's base in space. The shaft points along z = x × y; the sensor's
/// axes are x and y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Base of the shaft, m.
    pub base_m: [f64; 3],
    /// First transverse axis, a unit vector.
    pub x: [f64; 3],
    /// Second transverse axis, a unit vector perpendicular to x.
    pub y: [f64; 3],
}

impl Pose {
    /// The direction of the shaft, x × y.
    #[inline]
    pub fn z(&self) -> [f64; 3] {
        cross(self.x, self.y)
    }
}

/// A flat plate with a textured surface. Its heights belong to it: a place has
/// the same height whenever it is touched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plate {
    /// A point of the mean plane, m: the origin of the surface's coordinates.
    pub point_m: [f64; 3],
    /// Normal of the plane, a unit vector on the whisker's side.
    pub normal: [f64; 3],
    /// First coordinate of the surface: a unit vector in the plane.
    pub along: [f64; 3],
    /// What it is made of.
    pub surface: Surface,
}

/// A pose as the plate sees it: along, across, and above it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Seen {
    /// Tip of the unbent shaft, m.
    pub(super) tip: V3,
    pub(super) x: V3,
    pub(super) y: V3,
    pub(super) z: V3,
}

impl Seen {
    /// A vector with these components along x, y and z.
    #[inline]
    pub(super) fn space(&self, [x, y, z]: V3) -> V3 {
        add(add(scale(x, self.x), y, self.y), z, self.z)
    }

    /// Components of a vector along x, y and z.
    #[inline]
    pub(super) fn body(&self, v: V3) -> V3 {
        [dot(v, self.x), dot(v, self.y), dot(v, self.z)]
    }

    /// This far on the straight way to another, 0 to 1.
    #[inline]
    pub(super) fn towards(&self, other: &Self, share: f64) -> Self {
        let mix = |a: V3, b: V3| add(a, share, sub(b, a));
        Self {
            tip: mix(self.tip, other.tip),
            x: mix(self.x, other.x),
            y: mix(self.y, other.y),
            z: mix(self.z, other.z),
        }
    }
}

impl Plate {
    /// `pose`, with a shaft of length `length_m`, in this plate's coordinates.
    pub(super) fn see(&self, pose: &Pose, length_m: f64) -> Seen {
        let normal = unit(self.normal, [0.0, 0.0, 1.0]);
        let along = across(self.along, normal);
        let side = cross(normal, along);
        let turn = |v: V3| [dot(along, v), dot(side, v), dot(normal, v)];
        let z = pose.z();
        let tip = add(pose.base_m, length_m, z);
        Seen {
            tip: turn(sub(tip, self.point_m)),
            x: turn(pose.x),
            y: turn(pose.y),
            z: turn(z),
        }
    }
}
