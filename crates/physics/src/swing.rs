//! A whisker that a motor swings: its pose at an angle, and a plate in its way.
//!
//! The motor's axis is the third axis of space and goes through the base. At the
//! angle θ the shaft points along (cos θ, sin θ, 0); protraction is towards
//! larger θ. The sensor's x is opposed to protraction, so that a plate in the
//! way makes it positive, as BIOTACT eq. 11 has it; its y is opposed to the axis.

use crate::outline::Outline;
use crate::pose::{Plate, Pose};
use crate::surface::Surface;

/// How a swung whisker stands, and how a plate faces it at first touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facing {
    /// Angle between shaft and plate in the plane of whisking, degrees, 0 to 80;
    /// 0: the shaft lies flat. What is above 0 draws the tip along the plate.
    pub slant_deg: f64,
    /// Inclination of the plate towards the motor's axis, degrees, ±80: friction
    /// then acts along y too.
    pub tilt_deg: f64,
    /// By how much the shaft points out of the plane of whisking, along the motor's axis,
    /// degrees, ±60: it sweeps a cone.
    pub elevation_deg: f64,
}

impl Facing {
    /// 30° and 20°: choices. A tip slides by 1 or 2 mm in an overlap of 10°.
    pub const USUAL: Self = Self {
        slant_deg: 30.0,
        tilt_deg: 20.0,
        elevation_deg: 0.0,
    };

    /// The whisker at the angle θ, rad: with an elevation e it points along
    /// (cos e cos θ, cos e sin θ, sin e).
    #[inline]
    pub fn pose(&self, theta_rad: f64) -> Pose {
        let (sine, cosine) = libm::sincos(theta_rad);
        let (up, level) = libm::sincos(self.elevation_deg.to_radians());
        Pose {
            base_m: [0.0; 3],
            x: [sine, -cosine, 0.0],
            y: [up * cosine, up * sine, -level],
        }
    }
}

impl Pose {
    /// At the angle θ, rad; see the top of this file.
    #[inline]
    pub fn swung(theta_rad: f64) -> Self {
        let (sine, cosine) = libm::sincos(theta_rad);
        Self {
            base_m: [0.0; 3],
            x: [sine, -cosine, 0.0],
            y: [0.0, 0.0, -1.0],
        }
    }
}

impl Plate {
    /// Where the tip of a straight shaft touches it at the angle θ, rad, and
    /// enters it by protraction.
    pub fn in_the_way(theta_rad: f64, length_m: f64, facing: &Facing, surface: Surface) -> Self {
        let (sine, cosine) = libm::sincos(theta_rad);
        let (up, reach) = libm::sincos(facing.elevation_deg.to_radians());
        let (slant, flat) = libm::sincos(facing.slant_deg.to_radians());
        let (tilt, level) = libm::sincos(facing.tilt_deg.to_radians());
        // Against protraction, against the shaft, and along the axis.
        let (back, inward) = (level * flat, level * slant);
        Self {
            point_m: [reach * cosine, reach * sine, up].map(|part| length_m * part),
            normal: [
                back * sine - inward * cosine,
                -back * cosine - inward * sine,
                tilt,
            ],
            along: [cosine, sine, 0.0],
            outline: Outline::PLANE,
            surface,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Facing, Plate, Pose};
    use crate::pose::PlateFrame;
    use crate::vector::{dot, sub};
    use crate::{Material, Surface};

    #[test]
    fn the_x_of_the_sensor_is_against_protraction_and_the_shaft_is_x_cross_y() {
        let (theta, ahead) = (0.7, 0.7 + 1e-6);
        let moved = sub(Pose::swung(ahead).z(), Pose::swung(theta).z());
        assert!((dot(moved, Pose::swung(theta).x) + 1e-6).abs() < 1e-12);
        let z = Pose::swung(theta).z();
        assert!((z[0] - theta.cos()).abs() < 1e-15 && (z[1] - theta.sin()).abs() < 1e-15);
    }

    #[test]
    fn a_straight_tip_touches_at_its_angle_and_then_enters() {
        let (theta, length) = (1.7, 0.112);
        for elevation_deg in [0.0_f64, 25.0] {
            let facing = Facing {
                elevation_deg,
                ..Facing::USUAL
            };
            let pose = facing.pose(theta);
            assert!((pose.z()[2] - elevation_deg.to_radians().sin()).abs() < 1e-15);
            assert!(dot(pose.x, pose.y).abs() < 1e-15 && (dot(pose.y, pose.y) - 1.0).abs() < 1e-15);
            // x is against protraction whatever the elevation.
            assert_eq!(pose.x, Pose::swung(theta).x);
            let plate = Plate::in_the_way(theta, length, &facing, Surface::of(Material::Flat));
            assert!((dot(plate.normal, plate.normal) - 1.0).abs() < 1e-12);
            let frame = PlateFrame::new(&plate);
            let above = |theta: f64| {
                let pose = frame.see(&facing.pose(theta));
                pose.place([0.0, 0.0, length])[2]
            };
            assert!(above(theta).abs() < 1e-15);
            // By L cos 30° cos 20° a radian; the cosine of the elevation shortens the way.
            let cosines = [30.0_f64, 20.0, elevation_deg].map(|degrees| degrees.to_radians().cos());
            let depth = length * cosines.iter().product::<f64>();
            let rate = (above(theta + 1e-6) - above(theta - 1e-6)) / 2e-6;
            assert!((rate + depth).abs() < 1e-6 * depth, "{rate} {depth}");
        }
        assert_eq!(Facing::USUAL.pose(theta), Pose::swung(theta));
        // The shaft is inclined to the plate by less than the slant, for the tilt.
        let flat = Surface::of(Material::Flat);
        let plate = Plate::in_the_way(theta, length, &Facing::USUAL, flat);
        let sine = -dot(Pose::swung(theta).z(), plate.normal);
        assert!((sine - 0.5 * 20.0_f64.to_radians().cos()).abs() < 1e-12);
    }
}
