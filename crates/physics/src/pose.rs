//! Where a whisker is, and the flat plate that it may touch.

use crate::outline::Outline;
use crate::surface::Surface;
use crate::vector::{V3, across, add, cross, dot, scale, sub, unit};

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

/// A flat plate with a textured surface, endless or with an end, or a round bar. Its heights
/// belong to it: a place has the same height whenever it is touched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plate {
    /// A point of the mean plane, m: the origin of the surface's coordinates.
    pub point_m: [f64; 3],
    /// Normal of the plane, a unit vector on the whisker's side.
    pub normal: [f64; 3],
    /// First coordinate of the surface: a unit vector in the plane.
    pub along: [f64; 3],
    /// Where it ends along that coordinate.
    pub outline: Outline,
    /// What it is made of.
    pub surface: Surface,
}

/// The axes of a plate in space: coordinates along it, across it, and above it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PlateFrame {
    point_m: V3,
    along: V3,
    side: V3,
    normal: V3,
}

impl PlateFrame {
    /// The axes of a plate, orthonormal whatever its directions are.
    pub(crate) fn new(plate: &Plate) -> Self {
        let normal = unit(plate.normal, [0.0, 0.0, 1.0]);
        let along = across(plate.along, normal);
        Self {
            point_m: plate.point_m,
            along,
            side: cross(normal, along),
            normal,
        }
    }

    #[inline]
    pub(crate) fn see(&self, pose: &Pose) -> PlatePose {
        let turn = |v: V3| [dot(self.along, v), dot(self.side, v), dot(self.normal, v)];
        let z = pose.z();
        PlatePose {
            base: turn(sub(pose.base_m, self.point_m)),
            x: turn(pose.x),
            y: turn(pose.y),
            z: turn(z),
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PlatePose {
    pub(crate) base: V3,
    pub(crate) x: V3,
    pub(crate) y: V3,
    pub(crate) z: V3,
}

impl PlatePose {
    /// A place with these components along x, y and z from the base.
    #[inline]
    pub(crate) fn place(&self, place: V3) -> V3 {
        add(self.base, 1.0, self.vector(place))
    }

    /// The direction that is up from the plate, along x, y and z.
    #[inline]
    pub(crate) fn up(&self) -> V3 {
        [self.x[2], self.y[2], self.z[2]]
    }

    /// A vector with these components along x, y and z, in the plate's coordinates.
    #[inline]
    pub(crate) fn vector(&self, [x, y, z]: V3) -> V3 {
        add(add(scale(x, self.x), y, self.y), z, self.z)
    }

    /// Components along x, y and z of a vector in the plate's coordinates.
    #[inline]
    pub(crate) fn components(&self, v: V3) -> V3 {
        [dot(v, self.x), dot(v, self.y), dot(v, self.z)]
    }

    /// This far on the straight way to another, 0 to 1.
    #[inline]
    pub(crate) fn towards(&self, other: &Self, share: f64) -> Self {
        let mix = |a: V3, b: V3| add(a, share, sub(b, a));
        Self {
            base: mix(self.base, other.base),
            x: mix(self.x, other.x),
            y: mix(self.y, other.y),
            z: mix(self.z, other.z),
        }
    }
}
